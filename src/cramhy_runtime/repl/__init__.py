"""The surfaces of Lisp: a session that evaluates texts, the prompts of ``roslisp_repl`` and of ``hy`` with their debugger, and the
JSON lines of ``cramhy eval``."""
