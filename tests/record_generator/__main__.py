"""`python -m record_generator`: see cli.py."""

from .cli import main

main()
