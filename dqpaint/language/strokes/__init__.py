"""Statement and pen state -> segments of the program.

A new stroke is a row in `vocabulary.words` and a function here.
"""
