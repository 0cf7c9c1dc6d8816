"""What can be added by one file and one line: names and where they are defined, and the keys that follow."""
