"""A program and an arm -> what will happen, before it runs: reach, limits, placement, retiming.

`prepared_motion` is the one way from a drawing to the start of a run, for forecasts, paintings and
studies alike. `check` reads a drawing; `forecast` and `forecast_report` say line by line what the
arm will meet; `placement` and `retiming` change the drawing so that it fits; `suggestions` are
fixes that were tried before they are given.
"""

__all__ = ["check", "placement", "prepared_motion", "reachability", "retiming"]
