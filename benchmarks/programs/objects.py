"""Programs on classes, structures and generic functions."""

from __future__ import annotations

from . import Program


class Arm:
    def side(self):
        return 0

    def reach(self):
        return 1


class LeftArm(Arm):
    def side(self):
        return 1

    def reach(self):
        return super().reach() + 1


class RightArm(Arm):
    def side(self):
        return 2

    def reach(self):
        return super().reach() + 2


def sides(n):
    arms, total = [LeftArm(), RightArm()], 0
    for _ in range(n):
        for arm in arms:
            total += arm.side()
    return total


def reaches(n):
    arms, total = [LeftArm(), RightArm()], 0
    for _ in range(n):
        for arm in arms:
            total += arm.reach()
    return total


class Spot:
    def __init__(self, x=0, y=0):
        self.x, self.y = x, y


def made(n):
    total = 0
    for i in range(n):
        total += Spot(x=i, y=2).x
    return total


def seen(n):
    spot = Spot(1, 2)
    for _ in range(n):
        spot.x = spot.x + spot.y
    return spot.x


class Place:
    __slots__ = ("x", "y")

    def __init__(self, x, y):
        self.x, self.y = x, y


def areas(n):
    places, total = [Place(i, 2) for i in range(n)], 0
    for place in places:
        place.y = 3
        total += place.x * place.y
    return total


PROGRAMS = [
    Program(
        "a call of a generic function",
        """(defclass arm () ()) (defclass left-arm (arm) ()) (defclass right-arm (arm) ())
           (defgeneric side (arm)) (defmethod side ((arm left-arm)) 1) (defmethod side ((arm right-arm)) 2)
           (defun sides (n)
             (let ((arms (list (make-instance 'left-arm) (make-instance 'right-arm))) (s 0))
               (dotimes (i n s) (dolist (arm arms) (incf s (side arm))))))""",
        "(sides 3000)",
        sides,
        3.0,
    ),
    Program(
        "call-next-method",
        """(defclass arm () ()) (defclass left-arm (arm) ()) (defclass right-arm (arm) ())
           (defgeneric reach (arm)) (defmethod reach ((arm arm)) 1)
           (defmethod reach ((arm left-arm)) (+ (call-next-method) 1)) (defmethod reach ((arm right-arm)) (+ (call-next-method) 2))
           (defun reaches (n)
             (let ((arms (list (make-instance 'left-arm) (make-instance 'right-arm))) (s 0))
               (dotimes (i n s) (dolist (arm arms) (incf s (reach arm))))))""",
        "(reaches 3000)",
        reaches,
        3.0,
    ),
    Program(
        "make-instance",
        """(defclass spot () ((x :initarg :x :initform 0 :accessor spot-x) (y :initarg :y :initform 0 :accessor spot-y)))
           (defun made (n) (let ((s 0)) (dotimes (i n s) (incf s (spot-x (make-instance 'spot :x i :y 2))))))""",
        "(made 3000)",
        made,
        3.0,
    ),
    Program(
        "accessors of an instance",
        """(defclass spot () ((x :initarg :x :initform 0 :accessor spot-x) (y :initarg :y :initform 0 :accessor spot-y)))
           (defun seen (n)
             (let ((spot (make-instance 'spot :x 1 :y 2)))
               (dotimes (i n (spot-x spot)) (setf (spot-x spot) (+ (spot-x spot) (spot-y spot))))))""",
        "(seen 5000)",
        seen,
    ),
    Program(
        "structures",
        """(defstruct place x y)
           (defun areas-of-places (n)
             (let ((places (loop for i below n collect (make-place :x i :y 2))) (s 0))
               (dolist (p places s) (setf (place-y p) 3) (incf s (* (place-x p) (place-y p))))))""",
        "(areas-of-places 4000)",
        areas,
    ),
]
