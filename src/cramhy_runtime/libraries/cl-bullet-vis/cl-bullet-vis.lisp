;;;; cl-bullet-vis: the window that the original draws a world in. Here the page of cramhy shows worlds, and there is no window.

(defpackage #:cl-bullet-vis
  (:nicknames #:bt-vis)
  (:use #:common-lisp #:cl-bullet)
  (:export #:bullet-world-window #:close-window #:camera-transform #:gl-objects #:*background-color* #:collision-shape-color))

(in-package #:cl-bullet-vis)

(defvar *background-color* '(0.8 0.8 0.8 1.0) "The colour behind a world, in a window; the page has its own.")

(defgeneric collision-shape-color (shape)
  (:documentation "The colour of the shape of a body: red, green, blue and how little is seen through it, from 0 to 1."))

(defclass bullet-world-window ()
  ((world :initarg :world :reader world)
   (camera-transform :initarg :camera-transform :initform nil :accessor camera-transform)
   (gl-objects :initform nil :accessor gl-objects))
  (:documentation "What a window would show: a world, from somewhere."))

(defun close-window (window)
  "Nothing is open, so nothing closes."
  (declare (ignore window))
  nil)
