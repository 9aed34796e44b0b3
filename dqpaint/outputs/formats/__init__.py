"""A painting -> the files of one format, one function a format."""
