;;;; SB-ROTATE-BYTE: (rotate-byte count bytespec integer), section 18.3 of SBCL's manual.

(defpackage #:sb-rotate-byte (:use #:common-lisp) (:export #:rotate-byte))
(in-package #:sb-rotate-byte)

(defun rotate-byte (count bytespec integer)
  "INTEGER with the byte BYTESPEC rotated to the left by COUNT bits, to the right if that is negative."
  (let* ((size (byte-size bytespec)) (part (ldb bytespec integer)) (left (if (zerop size) 0 (mod count size))))
    (dpb (logior (ash part left) (ash part (- left size))) bytespec integer)))

(provide "SB-ROTATE-BYTE")
