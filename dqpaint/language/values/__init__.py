"""Expressions and names -> checked values with units, or diagnostics.

A new function is a row in `vocabulary.words.FUNCTIONS` and one in `functions.TABLE`.
"""
