"""The time integrator: TR-BDF2 over wagon, liquid, contacts and rail, with located events."""
