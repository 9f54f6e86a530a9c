"""From a form to its values: definitions, declarations, places, what is known of symbols and functions (ANSI chapters 3 and 5)."""
