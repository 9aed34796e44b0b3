"""Tables, curves and pictures of a study -> one HTML page, charts, contact sheets."""
