"""A program and settings -> a painting: the run, its numbers and its pictures.

`paint` is the whole flow; `preview` the same without an arm. `validate` checks settings before
anything runs, `photos` solves the light of photographs, `scene` collects the lights, `picture`
exposes and develops the pictures, `video` the movies, `film_file` stores all that is needed to
develop again. `time_limit` ends what takes too long.
"""

__all__ = [
    "film_file",
    "paint",
    "photos",
    "picture",
    "plugins",
    "preview",
    "scene",
    "time_limit",
    "validate",
    "video",
]
