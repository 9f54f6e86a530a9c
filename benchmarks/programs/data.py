"""Programs on lists, vectors, tables and text."""

from __future__ import annotations

import io

from cramhy_runtime.lisp_core.data import Cons

from . import Program


def formatted(n):
    items = []
    for i in range(n):
        items.append(f"{'Turtle'} goes to place {i} of {'kitchen'!s}.\n")
    return len(items[-1])


def written(n):
    stream = io.StringIO()
    for i in range(n):
        stream.write("place ")
        stream.write(str(i))
        stream.write("\n")
    return len(stream.getvalue())


def extended(n):
    items = []
    for i in range(n):
        items.append(i)
    return len(items)


def destructured(n):
    item, total = (1, (2, 3), 4), 0
    for _ in range(n):
        a, (b, c), d = item
        total += a + b + c + d
    return total


def scaled(n):
    numbers = list(range(n))
    return len(list(map(lambda x: x * 3, numbers)))


def built(n):
    items = None
    for i in range(n):
        items = Cons(i, items)
    done = None
    while items is not None:
        items.cdr, done, items = done, items, items.cdr
    return done.car


def collected(n):
    return len([i * i for i in range(1, n + 1) if i % 2 == 0])


def searched(n):
    pairs, total = [(i, i) for i in range(50)], 0
    for i in range(n):
        total += next(value for key, value in pairs if key == i % 50)
    return total


def hashed(n):
    table = {}
    for i in range(n):
        table[i] = i
    total = 0
    for i in range(n):
        total += table.get(i, 0)
    return total


def ordered(n):
    pairs = [(i * 7919 % n, i) for i in range(n)]
    pairs.sort(key=lambda pair: pair[0])
    return pairs[1][1]


def chosen(n):
    numbers = list(range(n))
    total = 0
    for x in [x for x in numbers if x % 3]:
        total += x
    return total


def vowels(n):
    text, count = "the turtle draws a house beside the kitchen " * n, 0
    for char in text:
        if char in "aeiou":
            count += 1
    return count


PROGRAMS = [
    Program(
        "format in a loop",
        """(defun formatted (n)
             (let ((l nil))
               (dotimes (i n (length (first l))) (push (format nil "~a goes to place ~d of ~a.~%" "Turtle" i "kitchen") l))))""",
        "(formatted 2000)",
        formatted,
        5.0,
    ),
    Program(
        "with-output-to-string",
        """(defun written (n)
             (length (with-output-to-string (stream)
                       (dotimes (i n) (write-string "place " stream) (princ i stream) (terpri stream)))))""",
        "(written 2000)",
        written,
        5.0,
    ),
    Program(
        "vector-push-extend",
        """(defun extended (n)
             (let ((v (make-array 0 :adjustable t :fill-pointer 0))) (dotimes (i n (length v)) (vector-push-extend i v))))""",
        "(extended 10000)",
        extended,
    ),
    Program(
        "destructuring-bind",
        """(defun destructured (n)
             (let ((item '(1 (2 3) 4)) (total 0))
               (dotimes (i n total) (destructuring-bind (a (b c) d) item (incf total (+ a b c d))))))""",
        "(destructured 5000)",
        destructured,
    ),
    Program(
        "mapcar",
        "(defun scaled (n) (let ((numbers (loop for i below n collect i))) (length (mapcar (lambda (x) (* x 3)) numbers))))",
        "(scaled 10000)",
        scaled,
    ),
    Program("push and nreverse", "(defun built (n) (let ((l nil)) (dotimes (i n) (push i l)) (car (nreverse l))))", "(built 20000)", built),
    Program(
        "loop collect when",
        "(defun collected (n) (length (loop for i from 1 to n when (evenp i) collect (* i i))))",
        "(collected 10000)",
        collected,
    ),
    Program(
        "assoc",
        """(defun searched (n)
             (let ((a (loop for i below 50 collect (cons i i))) (s 0)) (dotimes (i n s) (incf s (cdr (assoc (mod i 50) a))))))""",
        "(searched 2000)",
        searched,
    ),
    Program(
        "a hash table filled and read",
        """(defun hashed (n)
             (let ((h (make-hash-table)) (total 0))
               (dotimes (i n) (setf (gethash i h) i))
               (dotimes (i n total) (incf total (gethash i h 0)))))""",
        "(hashed 10000)",
        hashed,
    ),
    Program(
        "sort by a key",
        """(defun ordered (n)
             (let ((pairs (loop for i below n collect (cons (mod (* i 7919) n) i)))) (cdr (second (sort pairs #'< :key #'car)))))""",
        "(ordered 3000)",
        ordered,
    ),
    Program(
        "remove-if, reduce",
        "(defun chosen (n) (reduce #'+ (remove-if (lambda (x) (zerop (mod x 3))) (loop for i below n collect i))))",
        "(chosen 10000)",
        chosen,
    ),
    Program(
        "characters of a text",
        """(defun vowels (n)
             (let ((text (apply #'concatenate 'string (loop repeat n collect "the turtle draws a house beside the kitchen "))) (count 0))
               (loop for char across text do (when (find char "aeiou") (incf count)))
               count))""",
        "(vowels 100)",
        vowels,
    ),
]
