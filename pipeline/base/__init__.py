"""Units, quantities, tables, files, disk cache, worker processes, progress."""
