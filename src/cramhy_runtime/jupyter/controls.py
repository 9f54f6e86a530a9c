"""The controls of plan time in a notebook: pause, go on, one step, the speed. ``%pace`` shows them.

A button needs a way back from the page to the kernel, and the front ends give one to widgets only. So the controls are made with
ipywidgets. VS Code has what it needs for them, and JupyterLab has it if ipywidgets is installed beside it. It is optional: without it
`Controls` raises `ImportError`. The messages of widgets are answered while a cell runs.
"""

from __future__ import annotations

import comm

from cramhy_runtime import kernel

CONTROL = "jupyter.widget.control"
FAST, WALL = "as fast as possible", "wall time"
SPEEDS = {FAST: None, "0.2 x": 0.2, "0.5 x": 0.5, "1 x": 1.0, "2 x": 2.0, "5 x": 5.0}
"""Speeds of virtual time, in plan seconds per second."""
WIDTHS = {"pause": 8, "step": 6, "size": 9, "speed": 16}
"""Of the controls, in em."""


def serve_widgets(handlers):
    """Let the comm messages be answered: enter their handlers into the table ``handlers`` of a channel."""
    manager = comm.get_comm_manager()
    for kind in ("comm_open", "comm_msg", "comm_close"):
        handlers[kind] = getattr(manager, kind)
    manager.register_target(CONTROL, _control_opened)
    return manager


def _control_opened(opened, message):
    """A page asks for the widgets that there are. The module is loaded only then."""
    try:
        from ipywidgets import Widget, register_comm_target
    except ImportError:
        opened.close()
        return
    register_comm_target()
    Widget.handle_control_comm_opened(opened, message)


class Controls:
    """The controls. post: lets a function run with the baton; told: lets a function run in the loop of messages."""

    def __init__(self, post, told):
        import ipywidgets

        self._post, self._told = post, told
        wide = {name: {"width": f"{width}em", "flex": "0 0 auto"} for name, width in WIDTHS.items()}
        self.pause = ipywidgets.ToggleButton(description="Pause", icon="pause", layout=wide["pause"])
        self.step = ipywidgets.Button(description="Step", icon="step-forward", layout=wide["step"])
        plain = {"description_width": "initial"}
        size = {"value": 0.5, "min": 0.001, "max": 3600, "step": 0.1}
        self.size = ipywidgets.BoundedFloatText(**size, description="of (s)", style=plain, layout=wide["size"])
        self.speed = ipywidgets.Dropdown(options=[*SPEEDS, WALL], description="speed", style=plain, layout=wide["speed"])
        self.time = ipywidgets.Label()
        self.box = ipywidgets.HBox([self.pause, self.step, self.size, self.speed, self.time], layout={"flex_flow": "row wrap"})
        self._follows = False  # whether the controls are set to what is, and are not used
        self.pause.observe(self._paused, "value")
        self.step.on_click(self._stepped)
        self.speed.observe(self._sped, "value")

    def bundle(self):
        """The mime bundle that shows them."""
        return self.box._repr_mimebundle_()

    # ------------------------------------------------------------------------------------------ used: in the loop of messages

    def _paused(self, change):
        if not self._follows:
            wanted = change["new"]
            self._post(lambda: self._set(lambda pace: pace.pause() if wanted else pace.resume()))

    def _stepped(self, _):
        seconds = self.size.value
        self._post(lambda: self._set(lambda pace: pace.step(seconds)))

    def _sped(self, change):
        if not self._follows:
            wanted = change["new"]
            self._post(lambda: self._set_speed(wanted))

    # -------------------------------------------------------------------------------------------------------- with the baton

    def _set(self, change):
        pace = kernel.pace()
        if pace.virtual:  # the wall's time cannot be held, and then the buttons are off
            change(pace)
        self.follow()

    def _set_speed(self, wanted):
        kernel.set_clock("wall" if wanted == WALL else "virtual")
        if wanted != WALL:
            kernel.pace().set_speed(SPEEDS[wanted])
        self.follow()

    def follow(self):
        """Show how time passes now. Called with the baton."""
        pace, now = kernel.pace(), kernel.now()
        virtual, paused = pace.virtual, pace.paused
        speed = WALL if not virtual else next((name for name, value in SPEEDS.items() if value == pace.speed), FAST)
        self._told(lambda: self._show(virtual, paused, speed, now))

    def _show(self, virtual, paused, speed, now):
        self._follows = True
        try:
            self.pause.disabled = self.step.disabled = not virtual
            self.pause.value = paused
            self.pause.description = "Go on" if paused else "Pause"
            self.speed.value = speed
            self.time.value = f"{now:.1f} s, " + ("paused" if paused else "virtual time" if virtual else "wall time")
        finally:
            self._follows = False
