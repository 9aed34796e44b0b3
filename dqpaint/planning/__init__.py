"""A program and an arm -> what will happen, before it runs: reach, limits, placement, retiming.

`prepared_motion` leads from a drawing to the start of a run, for forecasts, paintings and studies
alike. `check` reads a drawing; `forecast` and `forecast_report` predict limits line by line;
`placement`, `corner_limits` and `retiming` change the drawing so that it fits; `suggestions` are
fixes that were tried before they are printed.
"""

__all__ = [
    "check", "corner_limits", "forecast_report", "motion_advice", "placement", "prepared_motion",
    "reachability", "retiming",
]
