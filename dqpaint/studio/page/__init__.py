"""A drawing and what the workers answer -> what is seen of one open page."""
