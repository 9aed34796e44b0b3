"""Many runs of one question: what goes in is a drawing and choices, what comes out is a table."""
