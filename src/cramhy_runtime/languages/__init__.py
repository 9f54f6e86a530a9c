"""The languages in which plans are written, on top of all rooms: nothing below them knows that they are there."""
