"""`python -m blind_tracing`: see cli.py."""

from .cli import main

main()
