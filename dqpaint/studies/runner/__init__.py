"""Runs -> results, kept in a journal: worker processes, batches of seeds, a Dask cluster."""
