"""A folder of references and new runs -> gates: alike, or where and by how much they differ."""
