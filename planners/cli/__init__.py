"""The command line, one file a command; `main` puts them together.

Every command imports what it needs when it runs, so that ``--help`` is instant.
"""
