"""Swank: how Emacs talks to a session. SLIME, and SLY as far as it says the same, connect to a socket and send calls.

The protocol is that of SLIME 2.27: frames with S-expressions, calls with answers, and events in both directions. All that the calls do is
done by the room ``session``, which other surfaces use, too: evaluation with interruption, completion, arglists, lookup, inspection,
the calls on a stack. This room says it in the words of Emacs. Nothing listens until somebody asks, and then on loopback (law 9).

A call runs in a task of its own, so Emacs is answered while a plan runs, and several of them are. ``C-c C-c`` ends the form through the
cleanup of its plan. An error opens the debugger in the task that failed.

Where the parts are: `wire` frames and S-expressions; `server` the thread that talks to clients, `sockets` where it listens, `secret` what
lets a client in, `errors` why it cannot start; `connection` the messages of a client; `rpcs` the table of calls; `calls` the calls
themselves; `debugger` sldb; `inspector`, `presentations` objects that Emacs shows; `streams` where programs print; `images` what they move;
`places` locations in texts; `packages` their prompts; `indentation` how Emacs indents macros; `reasons` why a call failed; `slime_version`
what to tell SLIME; `package` SWANK and SWANK-LOADER, which SLIME calls.
"""
