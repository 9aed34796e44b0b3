"""Laws that remember, learn or look ahead, one a file: controller input and gains -> a command."""
