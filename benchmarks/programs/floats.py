"""Programs whose numbers are floats, each with double-floats and with single-floats: arrays, objects, functions, lists.

The numbers are small multiples of a half, so that both kinds give what Python gives.
"""

from __future__ import annotations

import functools
import math

from . import Program


def product_of_floats(n):
    a = [[i + j * 0.5 for j in range(n)] for i in range(n)]
    b = [[i * 0.5 - j for j in range(n)] for i in range(n)]
    c = [[0.0] * n for _ in range(n)]
    for i in range(n):
        for j in range(n):
            total = 0.0
            for k in range(n):
                total += a[i][k] * b[k][j]
            c[i][j] = total
    return c[1][2] + c[n - 1][n - 2]


class Body:
    __slots__ = "place", "speed"

    def __init__(self, place, speed):
        self.place, self.speed = place, speed


def moved(n):
    body = Body(0.0, 1.5)
    for _ in range(n):
        body.place = body.place + body.speed * 0.5
        if body.place > 100.0:
            body.place = body.place - 100.0
    return round(body.place * 4)


def smoothed(n):
    v = [0.0] * n
    for i in range(n):
        v[i] = (i % 16) * 0.5
    total = 0.0
    for i in range(1, n - 1):
        total = total + (v[i - 1] + v[i + 1]) * 0.5 - v[i]
    return round(total * 4)


def between(a, b, w):
    return a + w * (b - a)


def blended(n):
    x = 0.0
    for _ in range(n):
        x = between(x, 8.0, 0.5)
        if x > 7.0:
            x = 1.0
    return round(x * 8)


def longest(n):
    points = [(i % 7) * 0.5 for i in range(n)]
    return round(functools.reduce(lambda one, other: one + other, [x * 2.0 for x in points]) * 2)


def root(x):
    guess = 1.0
    for _ in range(8):
        guess = 0.5 * (guess + x / guess)
    return guess


def roots(n):
    total = 0
    for i in range(n):
        total += round(root(i + 1.0))
    return total


def turned(n):
    x, y, angle = 1.0, 0.0, 0.0
    inside = 0
    for _ in range(n):
        angle = angle + 0.125
        x, y = math.cos(angle), math.sin(angle)
        if math.sqrt(x * x + y * y) < 2.0:
            inside += 1
    return inside


KINDS = ("double-floats", "d0"), ("single-floats", "f0")
TEMPLATES = [
    (
        "matrices of {}",
        """(defun product-of-{} (n)
             (let ((a (make-array (list n n))) (b (make-array (list n n))) (c (make-array (list n n))))
               (dotimes (i n)
                 (dotimes (j n) (setf (aref a i j) (+ i (* j 0.5#)) (aref b i j) (- (* i 0.5#) j))))
               (dotimes (i n)
                 (dotimes (j n)
                   (let ((total 0.0#))
                     (dotimes (k n) (incf total (* (aref a i k) (aref b k j))))
                     (setf (aref c i j) total))))
               (+ (aref c 1 2) (aref c (1- n) (- n 2)))))""",
        "(product-of-{} 16)",
        product_of_floats,
        6.0,
    ),
    (
        "an instance with {}",
        """(defclass body-of-{} () ((place :initarg :place :accessor place-of-{}) (speed :initarg :speed :accessor speed-of-{})))
           (defun moved-by-{} (n)
             (let ((body (make-instance 'body-of-{} :place 0.0# :speed 1.5#)))
               (dotimes (i n (nth-value 0 (round (* (place-of-{} body) 4))))
                 (incf (place-of-{} body) (* (speed-of-{} body) 0.5#))
                 (when (> (place-of-{} body) 100.0#) (decf (place-of-{} body) 100.0#)))))""",
        "(moved-by-{} 5000)",
        moved,
    ),
    (
        "a typed vector of {}",
        """(defun smoothed-{} (n)
             (let ((v (make-array n :element-type (type-of 0.5#) :initial-element 0.0#)) (total 0.0#))
               (dotimes (i n) (setf (aref v i) (* (mod i 16) 0.5#)))
               (loop for i from 1 below (1- n)
                     do (setf total (+ total (- (* (+ (aref v (1- i)) (aref v (1+ i))) 0.5#) (aref v i)))))
               (nth-value 0 (round (* total 4)))))""",
        "(smoothed-{} 4000)",
        smoothed,
    ),
    (
        "calls with {}",
        """(defun between-{} (a b w) (+ a (* w (- b a))))
           (defun blended-{} (n)
             (let ((x 0.0#))
               (dotimes (i n (nth-value 0 (round (* x 8))))
                 (setf x (between-{} x 8.0# 0.5#))
                 (when (> x 7.0#) (setf x 1.0#)))))""",
        "(blended-{} 5000)",
        blended,
    ),
    (
        "mapcar and reduce of {}",
        """(defun longest-of-{} (n)
             (let ((points (loop for i below n collect (* (mod i 7) 0.5#))))
               (nth-value 0 (round (* 2 (reduce #'+ (mapcar (lambda (x) (* x 2.0#)) points)))))))""",
        "(longest-of-{} 5000)",
        longest,
    ),
    (
        "roots of {} by Newton",
        """(defun root-{} (x)
             (let ((guess 1.0#)) (dotimes (i 8 guess) (setf guess (* 0.5# (+ guess (/ x guess)))))))
           (defun roots-{} (n)
             (let ((total 0)) (dotimes (i n total) (incf total (round (root-{} (+ i 1.0#)))))))""",
        "(roots-{} 500)",
        roots,
    ),
    (
        "sines of {}",
        """(defun turned-{} (n)
             (let ((x 1.0#) (y 0.0#) (angle 0.0#) (inside 0))
               (dotimes (i n inside)
                 (incf angle 0.125#)
                 (setf x (cos angle) y (sin angle))
                 (when (< (sqrt (+ (* x x) (* y y))) 2.0#) (incf inside)))))""",
        "(turned-{} 4000)",
        turned,
    ),
]


def _program(kind, end, name, lisp, call, python, *goal):
    def of_kind(text):
        return text.replace("{}", kind).replace("0#", "0" + end).replace("5#", "5" + end)

    return Program(name.format(kind), of_kind(lisp), of_kind(call), python, *goal)


PROGRAMS = [_program(kind, end, *template) for kind, end in KINDS for template in TEMPLATES]
