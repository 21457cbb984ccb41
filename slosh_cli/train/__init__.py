"""What makes a train of vehicles: the couplings between them."""
