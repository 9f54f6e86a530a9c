"""What one does with symbols and packages (ANSI chapters 10 and 11)."""
