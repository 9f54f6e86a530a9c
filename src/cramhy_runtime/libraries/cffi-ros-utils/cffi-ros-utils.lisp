;;;; cffi-ros-utils: libraries of C that ROS packages have. cramhy calls no functions of C, so that nothing is opened; paths are told.

(defpackage #:cffi-ros-utils
  (:use #:common-lisp #:cffi)
  (:export #:ros-library-paths #:ros-include-paths #:ros-grovel-file #:define-foreign-ros-library))

(in-package #:cffi-ros-utils)

(defun folder-of-package (package name)
  "The folder NAME of a ROS package, as a list of it; nil where there is none."
  (let ((path (ignore-errors (ros-load:ros-package-path package))))
    (when path
      (let ((folder (probe-file (format nil "~a/~a/" (string-right-trim "/" (namestring path)) name))))
        (and folder (list (string-right-trim "/" (namestring folder))))))))

(defun ros-library-paths (package)
  "The folders with the libraries of a ROS package."
  (folder-of-package package "lib"))

(defun ros-include-paths (package)
  "The folders with the header files of a ROS package."
  (folder-of-package package "include"))

(defclass ros-grovel-file (asdf:cl-source-file) ()
  (:documentation "A file that asks the compiler of C for sizes and constants. It is passed over."))

(defmethod asdf:perform ((operation asdf:compile-op) (file ros-grovel-file)) nil)
(defmethod asdf:perform ((operation asdf:load-op) (file ros-grovel-file)) nil)

(defmacro define-foreign-ros-library (alias library-file &optional package)
  "Define ALIAS as the library LIBRARY-FILE of a ROS package, as `cffi:define-foreign-library' does. It is not opened."
  (declare (ignore package))
  `(define-foreign-library ,alias (:unix ,library-file)))
