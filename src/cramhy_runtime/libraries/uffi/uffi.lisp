;;;; UFFI, the older of the portable interfaces to C. As with CFFI (../cffi/cffi.lisp) files that declare functions, types and libraries load;
;;;; constants, enums and strings of memory work, and a declared function that is called is an error that names it.

(defpackage #:uffi
  (:use #:common-lisp)
  (:import-from #:uiop #:getenv)
  (:import-from #:sb-ext #:string-to-octets #:octets-to-string)
  (:export
   #:+null-cstring-pointer+ #:*default-foreign-encoding* #:*foreign-encodings* #:allocate-foreign-object #:allocate-foreign-string
   #:char-array-to-pointer #:convert-from-cstring #:convert-from-foreign-string #:convert-from-foreign-usb8 #:convert-to-cstring
   #:convert-to-foreign-string #:def-array-pointer #:def-constant #:def-enum #:def-foreign-type #:def-foreign-var #:def-function
   #:def-pointer-var #:def-struct #:def-type #:def-union #:default-foreign-library-type #:deref-array #:deref-pointer
   #:ensure-char-character #:ensure-char-integer #:ensure-char-storable #:find-foreign-library #:foreign-encoded-octet-count
   #:foreign-library-types #:foreign-string-length #:free-cstring #:free-foreign-object #:get-slot-pointer #:get-slot-value #:getenv
   #:load-foreign-library #:make-null-pointer #:make-pointer #:no-i18n #:no-long-long #:null-char-p #:null-pointer-p
   #:octets-to-string #:pointer-address #:run-shell-command #:size-of-foreign-type #:string-to-octets #:with-cast-pointer
   #:with-cstring #:with-cstrings #:with-foreign-object #:with-foreign-objects #:with-foreign-string #:with-foreign-strings))

(in-package #:uffi)

(defparameter *default-foreign-encoding* :utf-8)
(defparameter *foreign-encodings* '(:latin-1 :utf-8 :utf-16))
(defvar +null-cstring-pointer+ (cffi:null-pointer))

;;; ------------------------------------------------------------------------------------------------------------- declarations

(defmacro def-constant (name value &optional export)
  `(progn (defconstant ,name ,value)
          ,@(when export `((export ',name)))
          ',name))

(defmacro def-type (name type)
  "A type of Lisp for a type of C: any."
  (declare (ignore type))
  `(deftype ,name () t))

(defmacro def-foreign-type (name type)
  (declare (ignore type))
  `',name)

(defmacro def-struct (name &rest fields)
  (declare (ignore fields))
  `',name)

(defmacro def-union (name &rest fields)
  `(def-struct ,name ,@fields))

(defmacro def-array-pointer (name type)
  `(def-foreign-type ,name ,type))

(defmacro def-enum (name entries &key (separator-string "#"))
  "Constants NAME#ENTRY for each of ENTRIES, a keyword or (keyword value)."
  (let ((next 0) (found '()))
    (dolist (entry entries)
      (when (consp entry)
        (setf next (second entry)))
      (push `(defconstant ,(intern (format nil "~A~A~A" name separator-string (if (consp entry) (first entry) entry))) ,next) found)
      (incf next))
    `(progn ,@(nreverse found) ',name)))

(defun names-of (name)
  "The Lisp name and the C name of a declaration: \"name\" or (\"name\" lisp-name)."
  (if (consp name)
      (values (second name) (first name))
      (values (intern (substitute #\- #\_ (string-upcase name))) name)))

(defmacro def-function (name arguments &key module returning)
  "Define a function for a function of C. When it is called, it is refused."
  (declare (ignore module returning))
  (multiple-value-bind (lisp-name c-name) (names-of name)
    (let ((parameters (unless (equal arguments '(:void)) (mapcar (lambda (argument) (if (consp argument) (first argument) argument)) arguments))))
      `(defun ,lisp-name ,parameters
         (declare (ignore ,@parameters))
         (cffi::refuse ',lisp-name ,c-name)))))

(defmacro def-foreign-var (name type module)
  (declare (ignore type module))
  (multiple-value-bind (lisp-name c-name) (names-of name)
    `(progn (define-symbol-macro ,lisp-name (cffi::refuse ',lisp-name ,c-name))
            ',lisp-name)))

(defmacro def-pointer-var (name value &optional documentation)
  `(defvar ,name ,value ,@(when documentation (list documentation))))

;;; ------------------------------------------------------------------------------------------------------------------ libraries

(defun default-foreign-library-type () "so")
(defun foreign-library-types () '("so"))

(defun find-foreign-library (names directories &key types drive-letters)
  "The first file of these names, folders and types that is there."
  (declare (ignore drive-letters))
  (dolist (folder (if (listp directories) directories (list directories)))
    (dolist (name (if (listp names) names (list names)))
      (dolist (type (or types (foreign-library-types)))
        (let ((path (make-pathname :name name :type type :defaults (uiop:ensure-directory-pathname folder))))
          (when (probe-file path)
            (return-from find-foreign-library path)))))))

(defun load-foreign-library (file &key module supporting-libraries force-load)
  "Nothing is loaded; the functions of the library say so when they are called."
  (declare (ignore module supporting-libraries force-load))
  (and file t))

(defun run-shell-command (control &rest arguments)
  "The exit code of the command that FORMAT makes."
  (nth-value 2 (uiop:run-program (apply #'format nil control arguments) :ignore-error-status t :output *standard-output*)))

;;; -------------------------------------------------------------------------------------------------- characters, strings, memory

(defun ensure-char-character (char) (if (integerp char) (code-char char) char))
(defun ensure-char-integer (char) (if (characterp char) (char-code char) char))
(defun ensure-char-storable (char) (ensure-char-integer char))
(defun null-char-p (char) (or (eql char 0) (eql char #\Null)))
(defun make-null-pointer (type) (declare (ignore type)) (cffi:null-pointer))
(defun null-pointer-p (pointer) (cffi:null-pointer-p pointer))

(defun convert-to-foreign-string (string &optional encoding) (declare (ignore encoding)) (cffi:foreign-string-alloc string))
(defun convert-to-cstring (string &optional encoding) (declare (ignore encoding)) (if string (cffi:foreign-string-alloc string) (cffi:null-pointer)))
(defun convert-from-cstring (pointer &optional encoding)
  (declare (ignore encoding))
  (if (stringp pointer) pointer (values (cffi:foreign-string-to-lisp pointer))))
(defun convert-from-foreign-string (pointer &key length encoding null-terminated-p)
  (declare (ignore encoding null-terminated-p))
  (let ((text (convert-from-cstring pointer))) (if length (subseq text 0 (min length (length text))) text)))
(defun free-cstring (pointer) (cffi:foreign-string-free pointer))
(defun foreign-encoded-octet-count (string &key encoding) (declare (ignore encoding)) (length (string-to-octets string)))
(defun foreign-string-length (pointer) (foreign-encoded-octet-count (convert-from-cstring pointer)))

(defmacro with-cstring ((variable string) &body body)
  `(let ((,variable (convert-to-cstring ,string)))
     (unwind-protect (progn ,@body) (free-cstring ,variable))))
(defmacro with-cstrings (bindings &body body)
  (if bindings `(with-cstring ,(first bindings) (with-cstrings ,(rest bindings) ,@body)) `(progn ,@body)))
(defmacro with-foreign-string ((variable string) &body body) `(with-cstring (,variable ,string) ,@body))
(defmacro with-foreign-strings (bindings &body body) `(with-cstrings ,bindings ,@body))

(defmacro with-foreign-object ((variable type) &body body) `(cffi:with-foreign-object (,variable ,type) ,@body))
(defmacro with-foreign-objects (bindings &body body)
  (if bindings `(with-foreign-object ,(first bindings) (with-foreign-objects ,(rest bindings) ,@body)) `(progn ,@body)))
(defmacro with-cast-pointer ((variable &rest parts) &body body)
  `(let ((,variable (cffi::refuse 'with-cast-pointer))) ,@(when parts (list (first parts))) ,@body))

(macrolet ((refused (&rest names)
             `(progn ,@(loop for name in names
                             collect `(defun ,name (&rest arguments)
                                        "Refused: there is no foreign memory of this kind."
                                        (declare (ignore arguments))
                                        (cffi::refuse ',name))
                             collect `(defun (setf ,name) (value &rest arguments)
                                        (declare (ignore value arguments))
                                        (cffi::refuse '(setf ,name)))))))
  (refused allocate-foreign-object allocate-foreign-string free-foreign-object get-slot-value get-slot-pointer deref-array deref-pointer
           size-of-foreign-type pointer-address make-pointer char-array-to-pointer convert-from-foreign-usb8))

(pushnew :uffi *features*)
