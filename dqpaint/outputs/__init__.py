"""A painting -> files, written as a whole or not at all: pictures, tables, summaries, movies.

A new format is a function in a new file of `formats` under `@writer(name, ending)`; it is found by
itself, by `draw --save`, `dqpaint.save` and `dqpaint list formats`. It takes a painting, and
`progress` where it takes long, and returns the bytes of its file; or those of several, by their
endings. One for real arms takes a trajectory, under `robot.for_arm`; `export` knows it as well.
Other packages bring formats by entry points `dqpaint.formats`.
"""

from dqpaint.outputs.registry import WRITERS, Need, Writer, writer

__all__ = ["WRITERS", "Need", "Writer", "citation", "files", "registry", "summary", "writer"]
