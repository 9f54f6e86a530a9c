"""Packages: their functions and errors, `defpackage`, and the tables of the built-in ones (ANSI chapter 11)."""
