"""The surfaces of Lisp: a session that evaluates texts, the console with its debugger, and ``cramhy eval``'s JSON lines."""
