"""One module a file format, each with ``write`` and, where the file holds enough, ``read``."""
