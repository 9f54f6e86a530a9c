"""Streams (ANSI chapter 21)."""
