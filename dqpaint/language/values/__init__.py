"""Expressions and names -> checked values with units; slips in them -> diagnostics.

A new function is a row in `vocabulary.words.FUNCTIONS` and one in `functions.TABLE`.
"""
