"""An SVG file -> piecewise curves with colours and source lines.

The guard bounds size, depth and copies before anything is worked out.
"""
