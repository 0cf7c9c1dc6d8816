"""What every part of a description has in common: strict keys, quantities, refusals."""
