"""Requests of pages -> their answers, made in processes that read only what they may."""
