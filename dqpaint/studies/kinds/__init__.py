"""The studies, one a file: drawings and choices -> runs -> tables, charts and verdicts."""

__all__ = ["compare", "replay", "study_result", "sweep", "tune", "tuning", "verify"]
