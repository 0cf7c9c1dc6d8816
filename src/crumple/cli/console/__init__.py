"""Console output of the commands: charts, tables, progress, error messages."""
