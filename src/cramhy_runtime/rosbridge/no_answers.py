"""What a caller is told instead of an answer when the server of a service has none to give.

rosbridge has one text for whatever went wrong. Some of them say something that the tools of ROS tell their users in words of their own, so
`protocol` writes these, and who calls, a tool in another terminal or a joined session, takes them apart; the text is all that both share.
"""

WITHOUT_REASON = "The service {} refused, without a reason."
SESSION_ENDS = "The session ended before the service {} answered."
NOBODY = "Nobody offers the service {}."
SERVER_GONE = "The server of the service {} went away before it answered."


def reason(call):
    """The text for a `ros.services.Call` that was lost or refused."""
    return SERVER_GONE.format(call.service.name) if call.lost else call.failure or WITHOUT_REASON.format(call.service.name)


def taken_apart(text, name):
    """(failure, lost), as of a `ros.services.Call` to the service NAME, from what came as TEXT instead of its answer."""
    return "" if text == WITHOUT_REASON.format(name) else text, text == SERVER_GONE.format(name)
