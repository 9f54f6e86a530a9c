"""From a form to its values: macros, definitions, places, and what is known about functions (ANSI chapters 3 and 5)."""
