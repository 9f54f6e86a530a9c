"""Files and the streams that read and write them (ANSI chapters 20 and 21)."""
