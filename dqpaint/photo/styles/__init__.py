"""A subject -> the curves of a style: each style a module, found by `photo.STYLE_WORDS`."""
