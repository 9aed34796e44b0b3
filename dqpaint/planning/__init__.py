"""A program and an arm -> what will happen, before it runs: reach, limits, placement, retiming.

`check` reads a drawing; `forecast` and `forecast_report` say line by line what the arm will meet;
`placement` and `retiming` change the drawing so that it fits; `suggestions` are fixes that were
tried before they are given.
"""

__all__ = ["check", "placement", "reachability", "retiming"]
