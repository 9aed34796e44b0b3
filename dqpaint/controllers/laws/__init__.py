"""The control laws, one a file: controller input and gains -> a command.

A new law is a function in a new file here, or in a folder of its paper, under
`@controller(name, source, gains)`.
"""
