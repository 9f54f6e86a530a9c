"""What keeps a server from running."""


class ServerError(Exception):
    """A server that cannot start; the text says why and what to do."""
