"""The keys of the input file, one file for each kind of part."""
