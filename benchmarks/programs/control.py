"""Programs that are mostly calls: lambda lists, several values, closures, specials, conditions and exits."""

from __future__ import annotations

from . import Program


def area(*, width=1, height=1):
    return width * height


def areas(n):
    total = 0
    for i in range(n):
        total += area(width=i, height=2)
    return total


def step(x, by=1):
    return x + by


def steps(n):
    total = 0
    for _ in range(n):
        total = step(step(total), 2)
    return total


def halved(x):
    return x // 2, x % 2


def values(n):
    total = 0
    for i in range(n):
        half, rest = halved(i)
        total += half + rest
    return total


def counter():
    count = 0

    def next_one():
        nonlocal count
        count += 1
        return count

    return next_one


def counted(n):
    one = counter()
    for _ in range(n):
        one()
    return one()


count = 0


def special(n):
    global count
    saved, count = count, 0
    try:
        for _ in range(n):
            count += 1
        return count
    finally:
        count = saved


def handled(n):
    total = 0
    for i in range(n):
        try:
            if i % 2 == 0:
                raise ValueError("x")
        except ValueError:
            total += 1
    return total


class Left(Exception):
    pass


def call(function):
    function()


def escaped(n):
    total = 0

    def leave():
        nonlocal total
        total += 1
        raise Left

    for _ in range(n):
        try:
            call(leave)
        except Left:
            pass
    return total


def queens(n):
    def place(row, columns):
        if row == n:
            return 1
        total = 0
        for column in range(n):
            for other, taken in enumerate(columns, 1):
                if taken == column or abs(taken - column) == other:
                    break
            else:
                total += place(row + 1, [column, *columns])
        return total

    return place(0, [])


PROGRAMS = [
    Program(
        "calls with &key",
        """(defun area (&key (width 1) (height 1)) (* width height))
           (defun areas (n) (let ((s 0)) (dotimes (i n s) (incf s (area :width i :height 2)))))""",
        "(areas 5000)",
        areas,
        3.0,
    ),
    Program(
        "calls with &optional",
        """(defun one-step (x &optional (by 1)) (+ x by))
           (defun steps (n) (let ((total 0)) (dotimes (i n total) (setf total (one-step (one-step total) 2)))))""",
        "(steps 5000)",
        steps,
        3.0,
    ),
    Program(
        "several values",
        """(defun halved (x) (values (floor x 2) (mod x 2)))
           (defun values-of (n)
             (let ((total 0)) (dotimes (i n total) (multiple-value-bind (half rest) (halved i) (incf total (+ half rest))))))""",
        "(values-of 5000)",
        values,
        3.0,
    ),
    Program(
        "a closure that counts",
        """(defun counter () (let ((count 0)) (lambda () (incf count))))
           (defun counted (n) (let ((one (counter))) (dotimes (i n) (funcall one)) (funcall one)))""",
        "(counted 10000)",
        counted,
    ),
    Program(
        "a special variable",
        "(defvar *count* 0) (defun special-count (n) (let ((*count* 0)) (dotimes (i n) (incf *count*)) *count*))",
        "(special-count 10000)",
        special,
    ),
    Program(
        "handler-case",
        """(defun handled (n)
             (let ((total 0)) (dotimes (i n total) (handler-case (when (evenp i) (error "x")) (error () (incf total))))))""",
        "(handled 4000)",
        handled,
    ),
    Program(
        "return-from out of a closure",
        """(defun call (f) (funcall f))
           (defun escaped (n)
             (let ((total 0)) (dotimes (i n total) (block b (call (lambda () (incf total) (return-from b nil)))))))""",
        "(escaped 3000)",
        escaped,
    ),
    Program(
        "queens",
        """(defun queens (n)
             (labels ((free (column columns)
                        (loop for taken in columns for other from 1
                              never (or (= taken column) (= (abs (- taken column)) other))))
                      (place (row columns)
                        (if (= row n)
                            1
                            (let ((total 0))
                              (dotimes (column n total)
                                (when (free column columns) (incf total (place (1+ row) (cons column columns)))))))))
               (place 0 nil)))""",
        "(queens 6)",
        queens,
    ),
]
