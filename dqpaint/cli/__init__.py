"""Arguments of the command line -> calls of the API and of studies -> tables, files and exit codes.

Only this room prints. `main` starts it and turns errors into messages and exit codes; `painting`,
`language`, `export` and `studies` hold the commands; `options` makes their options from the
settings; `report`, `listing` and `pose` lay results out as text. A new command is a function in one
of these files; it does no arithmetic and imports what it needs when it runs, so that `--help` and
`check` start without the simulator.
"""

__all__ = ["main", "terminal"]
