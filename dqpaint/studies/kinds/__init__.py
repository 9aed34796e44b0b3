"""The studies, one a file: drawings and choices -> runs -> tables, charts and verdicts."""

__all__ = ["compare", "replay", "sweep", "tune", "tune_report", "verify"]
