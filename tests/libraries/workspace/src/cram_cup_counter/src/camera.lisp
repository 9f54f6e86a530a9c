(in-package #:cram-cup-counter)

;;; The driver of the camera is a library of C. This file loads without it.

(cffi:define-foreign-library cup-camera
  (:darwin "libcupcamera.dylib")
  (:unix (:or "libcupcamera.so.1" "libcupcamera.so"))
  (t (:default "libcupcamera")))

(cffi:use-foreign-library cup-camera)

(cffi:defctype handle :pointer)

(cffi:defcenum colour
  :white
  (:red 4)
  :blue)

(cffi:defcstruct image
  (width :int)
  (height :int)
  (data :pointer))

(cffi:defcfun ("cupcam_grab" %grab) :int
  "Grabs an image."
  (camera handle)
  (image (:pointer (:struct image))))

(cffi:defcfun "camera_handle" handle
  (number :int))

(defun grab-image (number)
  (cffi:with-foreign-object (image '(:struct image))
    (%grab (camera-handle number) image)
    (cffi:foreign-slot-value image '(:struct image) 'width)))

(defparameter +colours+
  (mapcar (lambda (name) (cons name (cffi:foreign-enum-value 'colour name))) '(:white :red :blue)))
