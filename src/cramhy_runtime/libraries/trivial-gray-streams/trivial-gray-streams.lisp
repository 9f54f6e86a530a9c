;;;; Gray streams under the names of trivial-gray-streams 2.0. STREAM-READ-SEQUENCE and STREAM-WRITE-SEQUENCE have its lambda lists, in
;;;; which the bounds are required, and STREAM-FILE-POSITION is a function with a SETF function.

(defpackage #:trivial-gray-streams
  (:use #:common-lisp)
  (:import-from #:sb-gray
                #:fundamental-stream #:fundamental-input-stream #:fundamental-output-stream #:fundamental-character-stream
                #:fundamental-binary-stream #:fundamental-character-input-stream #:fundamental-character-output-stream
                #:fundamental-binary-input-stream #:fundamental-binary-output-stream #:stream-read-char #:stream-unread-char
                #:stream-read-char-no-hang #:stream-peek-char #:stream-listen #:stream-read-line #:stream-clear-input
                #:stream-write-char #:stream-line-column #:stream-start-line-p #:stream-write-string #:stream-terpri
                #:stream-fresh-line #:stream-finish-output #:stream-force-output #:stream-clear-output
                #:stream-advance-to-column #:stream-read-byte #:stream-write-byte)
  (:export
   #:fundamental-stream #:fundamental-input-stream #:fundamental-output-stream #:fundamental-character-stream
   #:fundamental-binary-stream #:fundamental-character-input-stream #:fundamental-character-output-stream
   #:fundamental-binary-input-stream #:fundamental-binary-output-stream #:stream-read-char #:stream-unread-char
   #:stream-read-char-no-hang #:stream-peek-char #:stream-listen #:stream-read-line #:stream-clear-input
   #:stream-write-char #:stream-line-column #:stream-start-line-p #:stream-write-string #:stream-terpri
   #:stream-fresh-line #:stream-finish-output #:stream-force-output #:stream-clear-output
   #:stream-advance-to-column #:stream-read-byte #:stream-write-byte
   #:stream-read-sequence #:stream-write-sequence #:stream-file-position #:trivial-gray-stream-mixin))

(in-package #:trivial-gray-streams)

(defgeneric stream-read-sequence (stream sequence start end &key &allow-other-keys)
  (:documentation "Fill SEQUENCE from START to END; the index of the first element that was not filled."))

(defgeneric stream-write-sequence (stream sequence start end &key &allow-other-keys)
  (:documentation "Write the elements of SEQUENCE from START to END."))

(defgeneric stream-file-position (stream)
  (:documentation "Where the stream is."))

(defgeneric (setf stream-file-position) (position stream)
  (:documentation "Go to POSITION; whether that was possible."))

;;; What a class does not define is done as SB-GRAY does it.

(defvar *asked* '() "The streams that are asked what SB-GRAY would do.")

(defun as-sb-gray (function stream &rest arguments)
  (let ((*asked* (cons stream *asked*)))
    (apply function stream arguments)))

(defmethod stream-read-sequence ((stream fundamental-input-stream) sequence start end &key)
  (as-sb-gray #'sb-gray:stream-read-sequence stream sequence start end))

(defmethod stream-write-sequence ((stream fundamental-output-stream) sequence start end &key)
  (as-sb-gray #'sb-gray:stream-write-sequence stream sequence start end))

(defmethod stream-file-position ((stream fundamental-stream))
  nil)

(defmethod (setf stream-file-position) (position (stream fundamental-stream))
  (declare (ignore position))
  nil)

(defmethod sb-gray:stream-read-sequence :around ((stream fundamental-input-stream) sequence &optional (start 0) end)
  (if (member stream *asked*)
      (call-next-method)
      (stream-read-sequence stream sequence start (or end (length sequence)))))

(defmethod sb-gray:stream-write-sequence :around ((stream fundamental-output-stream) sequence &optional (start 0) end)
  (if (member stream *asked*)
      (call-next-method)
      (stream-write-sequence stream sequence start (or end (length sequence)))))

(defmethod sb-gray:stream-file-position :around ((stream fundamental-stream) &optional position)
  (if position
      (setf (stream-file-position stream) position)
      (or (stream-file-position stream) (call-next-method))))

(defclass trivial-gray-stream-mixin () ()
  (:documentation "Old programs inherit from it. It does nothing."))
