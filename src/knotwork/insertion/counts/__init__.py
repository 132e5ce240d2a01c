"""What the methods cost: counted while they run, beside what the text says."""
