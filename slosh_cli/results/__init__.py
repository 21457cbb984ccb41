"""What a run produced: the result in memory, its history file and its tables."""
