"""What data/ was made from: the simulated corridor and rooms, and their sensors. The methods never import it."""
