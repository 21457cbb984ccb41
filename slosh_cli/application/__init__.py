"""What a person asks for, as functions of values with frozen results: nothing here prints, and nothing ends a process.

Progress and cancellation come in as callables. The command line and scripts in Python call the same functions.
"""
