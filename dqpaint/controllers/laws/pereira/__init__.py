"""Laws of Pereira 2016, one a file: controller input and gains -> a command."""
