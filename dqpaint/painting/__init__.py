"""A program and settings -> a painting: the run, its numbers and its pictures.

`paint` is the whole flow, to be read in a minute; `preview` the same without an arm. `validate`
checks settings before anything runs, `scene` says what shines, `picture` takes the photographs,
`video` the movies, `film_file` keeps what is needed to develop again.
"""

__all__ = ["film_file", "paint", "picture", "plugins", "preview", "scene", "validate", "video"]
