"""Hy: how plans are written in plain Hy (`plan_macros`, `expansion`), and how a Hy text goes on in Common Lisp (`reader`, `files`);
how what is wrong in a file, or ends a program, is told (`malformed`, `errors`).

What happens at a prompt is in the room ``repl``.
"""
