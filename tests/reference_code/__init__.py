"""A second, deliberately plain implementation of a stop, written from the model's equations alone.

It shares no code with the program and serves its tests as an oracle.
"""

from .plain_stop import PlainStop, stop

__all__ = ["PlainStop", "stop"]
