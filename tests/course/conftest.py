"""Solutions are not tests, whatever their tasks are called."""

collect_ignore = ["solutions"]
