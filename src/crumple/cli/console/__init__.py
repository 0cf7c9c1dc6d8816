"""What the verbs print with: charts, tables, progress, refusals."""
