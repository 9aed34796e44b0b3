"""A painting -> the files of one format: what is written, a function a format."""
