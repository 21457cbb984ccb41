"""Every claim of the program held against something that the program did not compute."""
