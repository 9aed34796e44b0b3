"""A folder of references and new runs -> limits on differences, and which are exceeded."""
