"""`python -m crumple` is the command `crumple`."""

from crumple.cli.main import main

main()
