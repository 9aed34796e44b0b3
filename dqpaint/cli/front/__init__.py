"""Words of a command -> what stands around its results: help pages, completion, colours, doctor.

`help_pages` has the base of all commands; `colours` is the only place that knows how a terminal is
told a colour; `streams` says which words go where.
"""

__all__: list[str] = []
