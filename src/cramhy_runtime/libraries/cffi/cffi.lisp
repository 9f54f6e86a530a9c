;;;; CFFI: cramhy calls no functions of C. A file that declares some loads, with its types, libraries and functions; a declared function
;;;; that is called is an error that names it, and so is all that touches foreign memory, apart from strings.

(defpackage #:cffi
  (:use #:common-lisp)
  (:export
   #:*built-in-float-types* #:*built-in-integer-types* #:*darwin-framework-directories* #:*default-foreign-encoding* #:*foreign-library-directories* #:callback #:canonicalize-symbol-name-case #:close-foreign-library
   #:convert-from-foreign #:convert-to-foreign #:defbitfield #:defcallback #:defcenum #:defcfun #:defcstruct #:defctype #:defcunion
   #:defcvar #:define-c-struct-wrapper #:define-foreign-library #:define-foreign-type #:define-parse-method #:defcfun-helper-forms
   #:expand-from-foreign #:expand-to-foreign #:foreign-alloc #:foreign-bitfield-symbol-list #:foreign-bitfield-symbols #:foreign-bitfield-value
   #:foreign-enum-keyword #:foreign-enum-keyword-list #:foreign-enum-value #:foreign-free #:foreign-funcall #:foreign-funcall-pointer
   #:foreign-library #:foreign-library-loaded-p #:foreign-not-implemented #:foreign-pointer #:foreign-slot-names
   #:foreign-slot-offset #:foreign-slot-pointer #:foreign-slot-value #:foreign-string-alloc #:foreign-string-free
   #:foreign-string-to-lisp #:foreign-symbol-pointer #:foreign-type-alignment #:foreign-type-size #:free-converted-object
   #:free-translated-object #:get-callback #:get-var-pointer #:inc-pointer #:lisp-string-to-foreign #:list-foreign-libraries
   #:load-foreign-library #:load-foreign-library-error #:make-pointer #:make-shareable-byte-vector #:mem-aptr #:mem-aref #:mem-ref
   #:null-pointer #:null-pointer-p #:pointer-address #:pointer-eq #:pointerp #:translate-camelcase-name #:translate-from-foreign
   #:translate-into-foreign-memory
   #:translate-name-from-foreign #:translate-name-to-foreign #:translate-to-foreign #:use-foreign-library #:with-foreign-array
   #:with-foreign-object #:with-foreign-objects #:with-foreign-pointer #:with-foreign-pointer-as-string #:with-foreign-slots
   #:with-foreign-string #:with-foreign-strings #:with-pointer-to-vector-data))

;;; Packages that use CFFI may have a NATIVE-NAMESTRING of their own.
(defpackage #:cffi-sys
  (:use #:common-lisp)
  (:import-from #:cffi #:canonicalize-symbol-name-case #:foreign-alloc #:foreign-free #:foreign-pointer #:inc-pointer #:make-pointer
                #:make-shareable-byte-vector #:null-pointer #:null-pointer-p #:pointer-address #:pointer-eq #:pointerp #:with-foreign-pointer
                #:with-pointer-to-vector-data)
  (:import-from #:sb-ext #:native-namestring)
  (:export #:canonicalize-symbol-name-case #:foreign-alloc #:foreign-free #:foreign-pointer #:inc-pointer #:make-pointer
           #:make-shareable-byte-vector #:native-namestring #:null-pointer #:null-pointer-p #:pointer-address #:pointer-eq #:pointerp
           #:with-foreign-pointer #:with-pointer-to-vector-data))

(defpackage #:cffi-features
  (:use #:common-lisp)
  (:export #:cffi-feature-p #:darwin #:flat-namespace #:no-foreign-funcall #:no-long-long #:ppc32 #:unix #:windows #:x86 #:x86-64))

(in-package #:cffi)

(defvar *foreign-library-directories* '())
(defvar *darwin-framework-directories* '())
(defvar *default-foreign-encoding* :utf-8)

(defun cffi-features:cffi-feature-p (feature)
  "Whether FEATURE, a symbol of CFFI-FEATURES or an expression as behind #+, holds: of the keywords of the same names."
  (if (consp feature)
      (ecase (intern (string (first feature)) :keyword)
        (:and (every #'cffi-features:cffi-feature-p (rest feature)))
        (:or (some #'cffi-features:cffi-feature-p (rest feature)))
        (:not (not (cffi-features:cffi-feature-p (second feature)))))
      (and (member (intern (string feature) :keyword) *features*) t)))

(defun canonicalize-symbol-name-case (name)
  "NAME as a symbol of the standard readtable is called."
  (string-upcase name))

(define-condition foreign-not-implemented (error)
  ((operation :initarg :operation :reader operation) (name :initarg :name :initform nil :reader name))
  (:report (lambda (condition stream)
             (format stream "~A cannot be called: cramhy calls no functions of C~@[ (here ~S)~].~%Use the Python module for that ~
                             library: (py:import name), then (name:function ...)."
                     (operation condition) (name condition)))))

(define-condition load-foreign-library-error (simple-error) ())

(defun refuse (operation &optional name)
  "The error that OPERATION, a Lisp function for the C function NAME or one of CFFI, cannot be done."
  (error 'foreign-not-implemented :operation operation :name name))

;;; ------------------------------------------------------------------------------------- what is declared, and does nothing

(defclass foreign-library ()
  ((name :initarg :name :reader foreign-library-name)))

(defvar *libraries* (make-hash-table :test 'eq))

(defmacro define-foreign-library (name-and-options &body clauses)
  (declare (ignore clauses))
  (let ((name (if (consp name-and-options) (first name-and-options) name-and-options)))
    `(progn (setf (gethash ',name *libraries*) (make-instance 'foreign-library :name ',name))
            ',name)))

(defmacro use-foreign-library (library)
  "Nothing is loaded; the functions of the library say so when they are called."
  (declare (ignore library))
  nil)

(defun load-foreign-library (library &key search-path)
  "As USE-FOREIGN-LIBRARY."
  (declare (ignore search-path))
  (if (symbolp library) (gethash library *libraries*) (make-instance 'foreign-library :name library)))

(defun close-foreign-library (library)
  (declare (ignore library))
  nil)

(defun foreign-library-loaded-p (library)
  (declare (ignore library))
  nil)

(defun list-foreign-libraries (&key loaded-only type)
  (declare (ignore type))
  (unless loaded-only
    (loop for library being the hash-values of *libraries* collect library)))

(defmacro defctype (name base-type &optional documentation)
  (declare (ignore base-type documentation))
  `',name)

(defclass foreign-struct-type () ()
  (:documentation "The class of the types of structures and unions of C; methods of users are for its subclasses."))

(defmacro defcstruct (name-and-options &body fields)
  "Define the class of the structure, :CLASS of its options or NAME-TCLASS."
  (declare (ignore fields))
  (destructuring-bind (name &key class &allow-other-keys) (if (consp name-and-options) name-and-options (list name-and-options))
    `(progn (defclass ,(or class (intern (format nil "~A-~A" name '#:tclass) (or (symbol-package name) *package*))) (foreign-struct-type) ())
            ',name)))

(defmacro defcunion (name-and-options &body fields)
  `(defcstruct ,name-and-options ,@fields))

(defmacro define-c-struct-wrapper (&rest parts)
  (declare (ignore parts))
  nil)

(defmacro define-foreign-type (name superclasses slots &rest options)
  `(defclass ,name ,superclasses ,slots
     ,@(remove-if (lambda (option) (member (first option) '(:actual-type :simple-parser))) options)))

(defmacro define-parse-method (name lambda-list &body body)
  (declare (ignore lambda-list body))
  `',name)

(defgeneric translate-to-foreign (value type))
(defgeneric translate-into-foreign-memory (value type pointer))
(defgeneric translate-from-foreign (value type))
(defgeneric free-translated-object (value type param))
(defgeneric expand-to-foreign (value type))
(defgeneric expand-from-foreign (value type))
(defgeneric translate-name-to-foreign (lisp-name package &optional varp))
(defgeneric translate-name-from-foreign (foreign-name package &optional varp))

(defmethod translate-name-to-foreign (lisp-name package &optional varp)
  (declare (ignore package))
  (let ((name (substitute #\_ #\- (string-downcase (symbol-name lisp-name)))))
    (if varp (string-trim '(#\*) name) name)))

(defmethod translate-name-from-foreign (foreign-name package &optional varp)
  (let ((name (substitute #\- #\_ (string-upcase foreign-name))))
    (intern (if varp (concatenate 'string "*" name "*") name) package)))

;;; ----------------------------------------------------------------------------------------------------- enums, bit fields

(defvar *enums* (make-hash-table :test 'eq) "Name of an enum or bit field -> list of (keyword . value).")

(defmacro defcenum (name-and-options &body entries)
  (let ((name (if (consp name-and-options) (first name-and-options) name-and-options)) (next 0) (found '()))
    (dolist (entry (remove-if #'stringp entries))
      (let ((key (if (consp entry) (first entry) entry)))
        (when (and (consp entry) (rest entry))
          (setf next (eval (second entry))))
        (push (cons key next) found)
        (incf next)))
    `(progn (setf (gethash ',name *enums*) ',(nreverse found)) ',name)))

(defmacro defbitfield (name-and-options &body masks)
  (let ((name (if (consp name-and-options) (first name-and-options) name-and-options)) (next 1) (found '()))
    (dolist (mask (remove-if #'stringp masks))
      (let ((key (if (consp mask) (first mask) mask)))
        (when (and (consp mask) (rest mask))
          (setf next (eval (second mask))))
        (push (cons key next) found)
        (setf next (ash 1 (integer-length next)))))
    `(progn (setf (gethash ',name *enums*) ',(nreverse found)) ',name)))

(defun entries-of (type)
  (or (gethash type *enums*) (error "There is no foreign enum or bit field ~S." type)))

(defun foreign-enum-value (type keyword &key (errorp t))
  (or (cdr (assoc keyword (entries-of type)))
      (when errorp (error "~S is not defined as a keyword for enum type ~S." keyword type))))

(defun foreign-enum-keyword (type value &key (errorp t))
  (or (car (rassoc value (entries-of type)))
      (when errorp (error "~S is not defined as a value for enum type ~S." value type))))

(defun foreign-enum-keyword-list (type)
  (mapcar #'car (entries-of type)))

(defun foreign-bitfield-symbol-list (type)
  (mapcar #'car (entries-of type)))

(defun foreign-bitfield-value (type symbols)
  (reduce #'logior symbols :key (lambda (symbol) (foreign-enum-value type symbol)) :initial-value 0))

(defun foreign-bitfield-symbols (type value)
  (loop for (symbol . mask) in (entries-of type)
        when (= mask (logand mask value)) collect symbol))

;;; ---------------------------------------------------------------------------------------- functions, variables, callbacks

(defun names-of (name-and-options)
  "The Lisp name and the C name of a declaration: NAME, \"name\", (\"name\" NAME options...) or (NAME \"name\")."
  (let* ((parts (if (consp name-and-options) name-and-options (list name-and-options)))
         (c-name (find-if #'stringp parts))
         (lisp-name (find-if (lambda (part) (and part (symbolp part) (not (keywordp part)))) parts)))
    (values (or lisp-name (translate-name-from-foreign c-name *package*))
            (or c-name (translate-name-to-foreign lisp-name *package*)))))

(defmacro defcfun (name-and-options return-type &body arguments)
  "Define a function for a function of C. When it is called, it is refused."
  (declare (ignore return-type))
  (multiple-value-bind (lisp-name c-name) (names-of name-and-options)
    (let* ((parameters (loop for argument in arguments
                             when (consp argument) collect (first argument)))
           (documentation (when (stringp (first arguments)) (list (first arguments)))))
      `(defun ,lisp-name (,@parameters ,@(when (member '&rest arguments) '(&rest others)))
         ,@documentation
         (declare (ignore ,@parameters ,@(when (member '&rest arguments) '(others))))
         (refuse ',lisp-name ,c-name)))))

(defmacro defcvar (name-and-options type &optional documentation)
  (declare (ignore type documentation))
  (multiple-value-bind (lisp-name c-name) (names-of name-and-options)
    `(progn (define-symbol-macro ,lisp-name (refuse ',lisp-name ,c-name))
            ',lisp-name)))

(defmacro defcallback (name-and-options return-type arguments &body body)
  (declare (ignore return-type arguments body))
  `',(if (consp name-and-options) (first name-and-options) name-and-options))

(defmacro foreign-funcall (name-and-options &rest arguments)
  (declare (ignore arguments))
  `(refuse 'foreign-funcall ,(if (consp name-and-options) (first name-and-options) name-and-options)))

(defmacro foreign-funcall-pointer (pointer options &rest arguments)
  (declare (ignore pointer options arguments))
  '(refuse 'foreign-funcall-pointer))

(defmacro callback (name)
  `(refuse 'callback ',name))

;;; ------------------------------------------------------------------------------------------------------------- sizes

(defvar *sizes*
  '((:char . 1) (:signed-char . 1) (:unsigned-char . 1) (:uchar . 1) (:short . 2) (:unsigned-short . 2) (:ushort . 2) (:int . 4)
    (:unsigned-int . 4) (:uint . 4) (:long . 8) (:unsigned-long . 8) (:ulong . 8) (:long-long . 8) (:llong . 8) (:unsigned-long-long . 8)
    (:ullong . 8) (:int8 . 1) (:uint8 . 1) (:int16 . 2) (:uint16 . 2) (:int32 . 4) (:uint32 . 4) (:int64 . 8) (:uint64 . 8)
    (:float . 4) (:double . 8) (:pointer . 8) (:size . 8) (:void . 0))
  "The bytes of C's own types on a machine of 64 bits, under Linux.")
(defvar *built-in-float-types* '(:float :double))
(defvar *built-in-integer-types* (set-difference (mapcar #'car *sizes*) '(:float :double :pointer :size :void)))

(defgeneric foreign-type-size (type)
  (:documentation "The bytes of TYPE. Of a structure, whose fields are not kept, it is refused.")
  (:method (type) (or (cdr (assoc type *sizes*)) (refuse 'foreign-type-size type))))

(defgeneric foreign-type-alignment (type)
  (:documentation "The bytes that TYPE is aligned to: its size.")
  (:method (type) (foreign-type-size type)))

;;; ------------------------------------------------------------------------------------------------------------ memory

;;; Pointers are numbers with a class. The memory of C cannot be had, but for strings that were put into it here.

(defvar *next-address* 4096)

(defstruct (foreign-pointer (:constructor make-pointer (address)) (:constructor pointer-to (octets address)) (:predicate pointerp)
                            (:copier nil) (:conc-name pointer-))
  "A pointer of C's. ADDRESS: its number, 0 of the null pointer. OCTETS: those of a string with the zero at their end, or nil."
  (address 0 :type (unsigned-byte 64) :read-only t)
  (octets nil))

(defmethod print-object ((pointer foreign-pointer) stream)
  (print-unreadable-object (pointer stream :type t)
    (cond ((null-pointer-p pointer) (write-string "null" stream))
          ((pointer-octets pointer) (format stream "to ~D octet~:P" (length (pointer-octets pointer))))
          (t (format stream "~(~X~)" (pointer-address pointer))))))

(defun null-pointer ()
  "The pointer to nothing."
  (make-pointer 0))

(defun null-pointer-p (pointer)
  "Whether POINTER points to nothing."
  (zerop (pointer-address pointer)))

(defun pointer-eq (one other)
  "Whether two pointers are the same address."
  (= (pointer-address one) (pointer-address other)))

(defun inc-pointer (pointer bytes)
  "The pointer that is so many BYTES behind POINTER."
  (let ((octets (pointer-octets pointer)))
    (pointer-to (and octets (<= 0 bytes (length octets)) (subseq octets bytes)) (+ (pointer-address pointer) bytes))))

(defun foreign-string-alloc (string &key (encoding *default-foreign-encoding*) (null-terminated-p t) (start 0) end)
  "A pointer to the octets of STRING."
  (let ((octets (sb-ext:string-to-octets string :external-format encoding :start start :end end)))
    (pointer-to (if null-terminated-p (concatenate '(vector (unsigned-byte 8)) octets #(0)) octets)
                (shiftf *next-address* (+ *next-address* (* 16 (ceiling (1+ (length octets)) 16)))))))

(defun foreign-string-free (pointer)
  (setf (pointer-octets pointer) (vector 0))
  nil)

(defun foreign-string-to-lisp (pointer &key (offset 0) count max-chars (encoding *default-foreign-encoding*))
  "The string at POINTER, up to its zero, and the number of octets that it takes; nil for the null pointer."
  (let ((octets (pointer-octets pointer)))
    (unless (or octets (null-pointer-p pointer)) (refuse 'foreign-string-to-lisp))
    (when octets
      (let* ((end (if count (+ offset count) (or (position 0 octets :start offset) (length octets))))
             (text (sb-ext:octets-to-string (coerce (subseq octets offset end) '(vector (unsigned-byte 8))) :external-format encoding)))
        (values (if max-chars (subseq text 0 (min max-chars (length text))) text) (- end offset))))))

(macrolet ((refused (&rest names)
             `(progn ,@(loop for name in names
                             collect `(defun ,name (&rest arguments)
                                        "Refused: there is no foreign memory."
                                        (declare (ignore arguments))
                                        (refuse ',name))))))
  (refused convert-from-foreign convert-to-foreign free-converted-object foreign-alloc foreign-free foreign-slot-names
           foreign-slot-offset foreign-slot-pointer foreign-slot-value foreign-symbol-pointer get-callback get-var-pointer
           lisp-string-to-foreign make-shareable-byte-vector mem-aptr mem-aref mem-ref))

(defun refused-body (operator variables body)
  "A form that refuses OPERATOR, and in which the compiler sees the BODY and its VARIABLES."
  `(let ,variables
     (declare (ignorable ,@variables))
     (refuse ',operator)
     ,@body))

(defun first-names (spec)
  "The variables that SPEC, (variable ...) or ((variable ...) ...), binds."
  (if (consp (first spec)) (mapcar #'first-name (first spec)) (list (first spec))))

(defun first-name (part)
  (if (consp part) (first (last part)) part))

(defmacro with-foreign-object ((variable type &optional count) &body body)
  (declare (ignore type count))
  (refused-body 'with-foreign-object (list variable) body))

(defmacro with-foreign-objects (specs &body body)
  (refused-body 'with-foreign-objects (mapcar #'first specs) body))

(defmacro with-foreign-pointer ((variable size &optional size-variable) &body body)
  (declare (ignore size))
  (refused-body 'with-foreign-pointer (remove nil (list variable size-variable)) body))

(defmacro with-foreign-pointer-as-string ((spec &rest options) &body body)
  (declare (ignore options))
  (refused-body 'with-foreign-pointer-as-string (first-names (if (consp spec) spec (list spec))) body))

(defmacro with-foreign-slots ((slots pointer type) &body body)
  (declare (ignore pointer type))
  (refused-body 'with-foreign-slots (mapcar #'first-name slots) body))

(defmacro with-foreign-string ((spec string &rest options) &body body)
  (declare (ignore string options))
  (refused-body 'with-foreign-string (if (consp spec) spec (list spec)) body))

(defmacro with-foreign-strings (specs &body body)
  (refused-body 'with-foreign-strings (mapcan (lambda (spec) (if (consp (first spec)) (copy-list (first spec)) (list (first spec)))) specs)
                body))

(defmacro with-foreign-array ((variable array type) &body body)
  (declare (ignore array type))
  (refused-body 'with-foreign-array (list variable) body))

(defmacro with-pointer-to-vector-data ((variable vector) &body body)
  (declare (ignore vector))
  (refused-body 'with-pointer-to-vector-data (list variable) body))

(macrolet ((refused (&rest names)
             `(progn ,@(loop for name in names
                             collect `(defun (setf ,name) (value &rest arguments)
                                        (declare (ignore arguments value))
                                        (refuse '(setf ,name)))))))
  (refused mem-aref mem-ref foreign-slot-value))
