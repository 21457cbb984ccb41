"""The track: rail on its foundation by the moving element method, and the contact of wheel and rail."""
