"""What pages say in words and tables."""
