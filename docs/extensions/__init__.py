"""What Sphinx does not have: pictures of drawings and commands, and pages made from registries."""
