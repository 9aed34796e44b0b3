"""Drawings and settings to vary -> many runs -> tables, pictures, verdicts.

    declared (parameters) -> kinds (what runs them)
    axes -> runs -> engine (journal, pool -> worker) -> results -> cells -> compare, sweep, tune
                                                               -> claims -> replay (measures)
                                                               -> gates  -> verify (references)

A run is plain data with a key, carried out by a worker process; its result is a line of the study's
journal. A new study says which runs it wants, hands them to `engine.carry_out_study`, and reads the
results in their order; what it keeps beside figures is a line in `run_arrays.KEEPERS`. One that
asks again after it has seen results, as `tune` does, opens an `engine.Study`. Runs that differ only
in their seeds may go as one of `batches`. `page` makes a report, `api` are the studies from Python,
`dask_pool` is a pool of workers elsewhere.
"""

__all__ = ["api", "gallery", "plot"]
