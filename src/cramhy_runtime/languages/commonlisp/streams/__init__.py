"""Streams in memory and of the terminal (ANSI chapter 21). Those of files are in ``files``."""
