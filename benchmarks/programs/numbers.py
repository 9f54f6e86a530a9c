"""Programs that compute: floats of both kinds, integers, arrays."""

from __future__ import annotations

import math

from . import Program


def fib(n):
    return n if n < 2 else fib(n - 1) + fib(n - 2)


def tak(x, y, z):
    return tak(tak(x - 1, y, z), tak(y - 1, z, x), tak(z - 1, x, y)) if y < x else z


def doubles(n):
    total, x = 0.0, 1.0
    for _ in range(n):
        total = total + x * x - 0.5 * x
        x = x + 0.25
    return total


def halves(n):
    total = 0
    for i in range(n):
        total += i * 0.5
    return total


def sums_of_three(n):
    total = 0
    for i in range(n):
        total = total + i + 1
    return total


def energies(n):
    total = 0
    for x in [i * 0.5 for i in range(n)]:
        total += x * x
    return total


def product_of_matrices(n):
    a = [[i + j for j in range(n)] for i in range(n)]
    b = [[i - j for j in range(n)] for i in range(n)]
    c = [[0] * n for _ in range(n)]
    for i in range(n):
        for j in range(n):
            total = 0
            for k in range(n):
                total += a[i][k] * b[k][j]
            c[i][j] = total
    return c[1][2] + c[n - 1][n - 2]


def sieve(n):
    prime = [True] * (n + 1)
    count = 0
    for i in range(2, n + 1):
        if prime[i]:
            count += 1
            for j in range(i * i, n + 1, i):
                prime[j] = False
    return count


def mandelbrot(n):
    inside = 0
    for row in range(n):
        for column in range(n):
            cr, ci = column * 3.0 / n - 2.0, row * 2.0 / n - 1.0
            zr = zi = 0.0
            for _ in range(30):
                zr, zi = zr * zr - zi * zi + cr, 2.0 * zr * zi + ci
                if zr * zr + zi * zi > 4.0:
                    break
            else:
                inside += 1
    return inside


def pendulum(n):
    angle, speed, step = 1.0, 0.0, 0.001
    for _ in range(n):
        speed = speed - 9.81 * math.sin(angle) * step
        angle = angle + speed * step
    return round(angle * 1000)


def collatz(n):
    longest = 0
    for start in range(1, n):
        steps, value = 0, start
        while value != 1:
            value = value // 2 if value % 2 == 0 else 3 * value + 1
            steps += 1
        longest = max(longest, steps)
    return longest


def nested(n):
    total = 0
    for _ in range(n):
        for j in range(n):
            total = total + j
    return total


PROGRAMS = [
    Program(
        "double-float arithmetic in a loop",
        """(defun doubles (n)
             (let ((total 0d0) (x 1d0))
               (dotimes (i n total)
                 (setf total (- (+ total (* x x)) (* 0.5d0 x)))
                 (incf x 0.25d0))))""",
        "(doubles 20000)",
        doubles,
        2.0,
    ),
    Program(
        "(* i 0.5) in a loop",
        "(defun halves (n) (let ((total 0)) (dotimes (i n total) (incf total (* i 0.5)))))",
        "(halves 20000)",
        halves,
        2.0,
    ),
    Program(
        "three-argument +",
        "(defun sums-of-three (n) (let ((total 0)) (dotimes (i n total) (setf total (+ total i 1)))))",
        "(sums-of-three 20000)",
        sums_of_three,
        2.0,
    ),
    Program(
        "matrix multiplication by aref",
        """(defun product-of-matrices (n)
             (let ((a (make-array (list n n))) (b (make-array (list n n))) (c (make-array (list n n))))
               (dotimes (i n) (dotimes (j n) (setf (aref a i j) (+ i j) (aref b i j) (- i j))))
               (dotimes (i n)
                 (dotimes (j n)
                   (let ((total 0))
                     (dotimes (k n) (incf total (* (aref a i k) (aref b k j))))
                     (setf (aref c i j) total))))
               (+ (aref c 1 2) (aref c (1- n) (- n 2)))))""",
        "(product-of-matrices 24)",
        product_of_matrices,
        6.0,
    ),
    Program(
        "a vector of floats made and summed",
        """(defun energies (n)
             (let ((floats (coerce (loop for i below n collect (* i 0.5)) 'vector)))
               (loop for x across floats sum (* x x))))""",
        "(energies 10000)",
        energies,
    ),
    Program("fib", "(defun fib (n) (if (< n 2) n (+ (fib (- n 1)) (fib (- n 2)))))", "(fib 18)", fib),
    Program("tak", "(defun tak (x y z) (if (< y x) (tak (tak (1- x) y z) (tak (1- y) z x) (tak (1- z) x y)) z))", "(tak 12 8 4)", tak),
    Program(
        "the sieve",
        """(defun sieve (n)
             (let ((prime (make-array (1+ n) :initial-element t)) (count 0))
               (loop for i from 2 to n
                     do (when (aref prime i)
                          (incf count)
                          (loop for j from (* i i) to n by i do (setf (aref prime j) nil))))
               count))""",
        "(sieve 10000)",
        sieve,
    ),
    Program(
        "Mandelbrot",
        """(defun mandelbrot (n)
             (let ((inside 0))
               (dotimes (row n inside)
                 (dotimes (column n)
                   (let ((cr (- (/ (* column 3d0) n) 2d0)) (ci (- (/ (* row 2d0) n) 1d0)) (zr 0d0) (zi 0d0))
                     (when (dotimes (k 30 t)
                             (psetf zr (+ (- (* zr zr) (* zi zi)) cr)
                                    zi (+ (* 2d0 zr zi) ci))
                             (when (> (+ (* zr zr) (* zi zi)) 4d0) (return nil)))
                       (incf inside)))))))""",
        "(mandelbrot 24)",
        mandelbrot,
    ),
    Program(
        "a pendulum, by sin",
        """(defun pendulum (n)
             (let ((angle 1d0) (speed 0d0) (step 0.001d0))
               (dotimes (i n)
                 (setf speed (- speed (* 9.81d0 (sin angle) step))
                       angle (+ angle (* speed step))))
               (nth-value 0 (round (* angle 1000)))))""",
        "(pendulum 10000)",
        pendulum,
    ),
    Program(
        "Collatz",
        """(defun collatz (n)
             (let ((longest 0))
               (loop for start from 1 below n
                     do (let ((steps 0) (value start))
                          (loop until (= value 1)
                                do (setf value (if (evenp value) (floor value 2) (1+ (* 3 value))))
                                   (incf steps))
                          (setf longest (max longest steps))))
               longest))""",
        "(collatz 400)",
        collatz,
    ),
    Program(
        "nested dotimes", "(defun nested (n) (let ((s 0)) (dotimes (i n s) (dotimes (j n) (setq s (+ s j))))))", "(nested 150)", nested
    ),
]
