"""Many paintings of one question: drawings and choices in, tables and pictures out.

    axes -> runs -> engine (record, pool -> worker) -> results -> cells -> compare, sweep
                                                              -> claims -> replay (replays)
                                                              -> gates  -> verify (references)

A run is plain data with a key, carried out by a worker process; its result is a line of the study's
record. A new study says which runs it wants, hands them to `engine.carry_out_study`, and reads the
results that come back in their order; what it needs beside figures is a line in
`keeping.KEEPERS`. One that asks again after it has seen results, as `tune` does, opens an
`engine.Study`. Runs that differ in their seeds alone may go as one of `batches`. `page` makes a
report of what a study shows, `calls` are the studies from Python, `cluster` is a pool of workers
elsewhere. `promise` stands apart: it needs no pictures, only tracks.
"""
