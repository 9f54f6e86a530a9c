"""The buffer of tf: which frame lies where in which other one, during the last ten seconds.

Frames form a forest. Every frame but the roots hangs on its parent by a link, and of each link the buffer keeps what was told
about it, second by second: ten buckets, one per second of the stamps, each with the transforms of its second in the order of their
stamps. A bucket is emptied when the first transform of a later second with the same place comes. So the memory is bounded, and what
is known ends ten seconds before the newest stamp. The transform between two frames is the product of the links on the way.

A time is looked for in each link of its own: between two stamps the translation is interpolated linearly and the rotation on the
sphere. The stamps are the nearest ones before and after the time, also where seconds lie between them in which nothing was told. No
time (``None`` or 0) means the newest of each link, so the stamps of links on the way may differ; the result has one of them. Static
transforms come with the stamp 0, and so are found by the newest only.

This is plain Python and knows of no nodes, clocks or waiting; what cannot be given is the exception `Unavailable`, which
``transformer.py`` turns into conditions. Source: cl-transforms.md 7.
"""

from __future__ import annotations

from bisect import bisect_right
from math import floor, isfinite

from cramhy_runtime.lisp_core.numbers import is_real
from ..transforms.quaternions import general, inverse, multiply, quaternion, rotated, slerp
from ..transforms.vectors import interpolate_vector, point, vector
from .frames import unslash_frame
from .stamped import TransformStamped
from cramhy_runtime.kernel.typing_names import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Iterable


SECONDS = 10
"""How many buckets a link has, and how far back it knows."""


class Unavailable(Exception):
    """A transform that the buffer cannot give. ``kind``: lookup, connectivity, extrapolation or empty; ``hint``: what to try.

    ``text`` is that of the original. Python sees ``told`` instead, if it is given.
    """

    def __init__(self, kind: str, text: str, hint: str | None = None, told: str | None = None):
        super().__init__(told or text)
        self.kind, self.text, self.hint = kind, text, hint


class Bucket:
    """The transforms of one second, by their stamps."""

    __slots__ = ("second", "stamps", "transforms")

    def __init__(self, second: int):
        self.second, self.stamps, self.transforms = second, [], []


class Link:
    """What is known of the link between a frame and its parent."""

    __slots__ = ("child", "newest", "buckets")

    def __init__(self, child: str):
        self.child, self.newest = child, None
        self.buckets = [None] * SECONDS

    @property
    def parent(self) -> str:
        return self.newest.frame_id

    def store(self, transform: TransformStamped) -> bool:
        """Keep ``transform``; false when its second has newer ones, or is forgotten, for what comes late is ignored."""
        if self.newest is not None and transform.frame_id != self.parent:
            if transform.stamp < self.newest.stamp:
                return False
            self.buckets = [None] * SECONDS  # it hangs on another frame now: what was before is another link
            self.newest = None
        second = floor(transform.stamp)
        bucket = self.buckets[second % SECONDS]
        if bucket is None or bucket.second < second:
            bucket = self.buckets[second % SECONDS] = Bucket(second)
        elif bucket.second > second or transform.stamp < bucket.stamps[-1]:
            return False
        if bucket.stamps and bucket.stamps[-1] == transform.stamp:
            bucket.transforms[-1] = transform  # told again: a static transform is, all the time
        else:
            bucket.stamps.append(transform.stamp)
            bucket.transforms.append(transform)
        if self.newest is None or transform.stamp >= self.newest.stamp:
            self.newest = transform
        return True

    def at(self, time: float | None) -> TransformStamped:
        """The transform at ``time``, as it was stored or interpolated; without a time the newest."""
        if not time:
            return self.newest
        second = floor(time)
        bucket = self.buckets[second % SECONDS]
        before = after = None
        if bucket is not None and bucket.second == second:
            place = bisect_right(bucket.stamps, time)
            if place and bucket.stamps[place - 1] == time:
                return bucket.transforms[place - 1]
            before = bucket.transforms[place - 1] if place else self._beside(second, -1)
            after = bucket.transforms[place] if place < len(bucket.stamps) else self._beside(second, 1)
        elif bucket is None or bucket.second < second:
            before, after = self._beside(second, -1), self._beside(second, 1)
        if before is not None and after is not None and floor(after.stamp) - floor(before.stamp) < SECONDS:
            return _between(before, after, time)
        if bucket is None:
            raise self._unknown_at(time, "empty", "The assertion (NOT (CL-TF::CACHE-EMPTY CL-TF::CACHE)) failed.")
        if abs(time - bucket.stamps[-1]) > SECONDS:
            raise self._unknown_at(time, "extrapolation", "Requested time points to the future. Cannot transform.")
        raise self._unknown_at(time, "extrapolation", "The requested time stamp does not point into the cache.")

    def _beside(self, second: int, step: int) -> TransformStamped | None:
        """The nearest transform of a second before ``second`` (``step`` -1) or after it (1), less than ten seconds away."""
        for other in range(second + step, second + step * SECONDS, step):
            bucket = self.buckets[other % SECONDS]
            if bucket is not None and bucket.second == other:
                return bucket.transforms[-1 if step < 0 else 0]
        return None

    def _unknown_at(self, time: float, kind: str, text: str) -> Unavailable:
        """The exception for a ``time`` that is not known. The original says "future" of the past, too."""
        stamps = [stamp for bucket in self.buckets if bucket is not None for stamp in bucket.stamps]
        way = f"from {self.child} to {self.parent}"
        if stamps == [0]:
            hint = f"The transform {way} is a static one, with the stamp 0: it is found when no time is asked for."
            return Unavailable(kind, text, hint, f"The transform {way} is not known at {float(time)} s. {hint}")
        first, last = float(min(stamps)), float(max(stamps))
        if time < first:
            where = f"{float(time)} s is {first - time:g} s in the past of that"
        elif time > last:
            where = f"{float(time)} s is {time - last:g} s in the future of that"
        else:
            where = f"{float(time)} s is in a gap of that, of ten seconds or more"
        hint = f"What is known of the transform {way} is from {first} to {last} s; {where}. Without a time the newest is taken."
        return Unavailable(kind, text, hint, f"The transform {way} is not known at {float(time)} s. {hint}")


def _between(before: TransformStamped, after: TransformStamped, time: float) -> TransformStamped:
    share = float((time - before.stamp) / (after.stamp - before.stamp))
    return TransformStamped(
        before.frame_id,
        before.child_frame_id,
        float(time),
        interpolate_vector(vector(point(before.translation)), vector(point(after.translation)), share),
        slerp(quaternion(general(before.rotation)), quaternion(general(after.rotation)), share),
    )


class FrameBuffer:
    """All links, by their child frames. Names of frames are kept without slashes."""

    def __init__(self) -> None:
        self.links: dict[str, Link] = {}
        self.roots: dict[str, None] = {}  # frame without a parent -> None: a frame that has been named as a parent is known

    @property
    def frames(self) -> list[str]:
        """The names of all frames, sorted."""
        return sorted({*self.links, *self.roots})

    def store(self, transform: TransformStamped) -> bool:
        """Keep the transform-stamped; false if it came too late. What is no transform between two frames is a `ValueError`."""
        parent, child = unslash_frame(transform.frame_id), unslash_frame(transform.child_frame_id)
        if not parent or not child:
            raise ValueError("A transform needs the names of both frames: the parent's and the child's.")
        if parent == child:
            raise ValueError(f"The frame {child} cannot be its own parent.")
        if not is_real(transform.stamp) or not isfinite(transform.stamp):
            raise ValueError(f"The transform from {child} to {parent} needs the time it holds for, in seconds.")
        point(transform.translation, "TRANSLATION")
        general(transform.rotation)
        if parent != transform.frame_id or child != transform.child_frame_id:
            transform = TransformStamped(parent, child, transform.stamp, transform.translation, transform.rotation)
        link = self.links.get(child)
        if link is None:
            link = Link(child)
        if not link.store(transform):
            return False
        self.links[child] = link
        self.roots[parent] = None
        return True

    def lookup(self, target: str, source: str, time: float | None = None) -> TransformStamped:
        """The transform that takes coordinates in ``source`` into those in ``target`` at ``time`` (seconds; ``None`` or 0: the newest).

        Both frames must be known. From a frame to itself it is the identity, at any time. Errors: `Unavailable`, and `ValueError` for a
        time that is none.
        """
        if time is not None and not (is_real(time) and isfinite(time)):
            when = float(time) if is_real(time) else time
            raise ValueError(f"The transform from {source} to {target} cannot be known at the time {when}: a time is a number of seconds.")
        from_source, from_target = self._ways(unslash_frame(target), unslash_frame(source))
        up = [link.at(time) for link in from_source]
        down = [link.at(time) for link in from_target]
        if not up and not down:
            link = self.links.get(unslash_frame(source))
            stamp = time or (link.newest.stamp if link is not None else 0.0)
            return TransformStamped(
                unslash_frame(target), unslash_frame(source), float(stamp), vector((0.0, 0.0, 0.0)), quaternion((0.0, 0.0, 0.0, 1.0))
            )
        if len(up) == 1 and not down:
            return up[0]
        stamp = up[-1].stamp if up else down[0].stamp
        translation, rotation = _product(up)
        if down:
            (dx, dy, dz), down_rotation = _product(down)
            back = inverse(down_rotation)
            bx, by, bz = rotated(back, (-dx, -dy, -dz))
            if up:
                ux, uy, uz = rotated(back, translation)
                translation, rotation = (bx + ux, by + uy, bz + uz), multiply(back, rotation)
            else:
                translation, rotation = (bx, by, bz), back
        return TransformStamped(unslash_frame(target), unslash_frame(source), stamp, vector(translation), quaternion(rotation))

    def _ways(self, target: str, source: str) -> tuple[list[Link], list[Link]]:
        """The links from ``source`` and from ``target`` up to the first frame that both hang on."""
        for frame in (source, target):
            if frame not in self.links and frame not in self.roots:
                raise Unavailable("lookup", f"The frame {frame} is not in the graph", self._frames_told())
        from_source, from_target = self._to_the_root(source), self._to_the_root(target)
        above = {source: 0, **{link.parent: count for count, link in enumerate(from_source, 1)}}
        for count, frame in enumerate((target, *(link.parent for link in from_target))):
            if frame in above:
                return from_source[: above[frame]], from_target[:count]
        raise Unavailable(
            "connectivity",
            f"The frames {source}\nand {target} are not connected in the reference frame tree",
            f"{source} hangs on {from_source[-1].parent if from_source else 'nothing'}, "
            f"{target} on {from_target[-1].parent if from_target else 'nothing'}.",
        )

    def _to_the_root(self, frame: str) -> list[Link]:
        links, seen = [], {frame}
        while (link := self.links.get(frame)) is not None:
            frame = link.parent
            links.append(link)
            if frame in seen:
                raise Unavailable(
                    "connectivity",
                    f"The frame {frame} hangs on itself in the reference frame tree",
                    "Somebody publishes transforms in a circle: " + " -> ".join([link.child for link in links] + [frame]),
                )
            seen.add(frame)
        return links

    def _frames_told(self) -> str:
        frames = self.frames
        return f"Known frames: {', '.join(frames[:20])}{', …' if len(frames) > 20 else ''}." if frames else "No frame is known yet."


def _product(transforms: Iterable[TransformStamped]) -> tuple[Any, Any]:
    """(translation, rotation) of the product of links on the way up, the first of which is applied first."""
    translation = rotation = None
    for transform in transforms:
        outer, (tx, ty, tz) = general(transform.rotation), point(transform.translation)
        if rotation is None:
            translation, rotation = (tx, ty, tz), outer
        else:
            vx, vy, vz = rotated(outer, translation)
            translation, rotation = (tx + vx, ty + vy, tz + vz), multiply(outer, rotation)
    return translation, rotation
