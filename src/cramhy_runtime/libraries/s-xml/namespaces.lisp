;;;; Names of elements and attributes are symbols. A namespace has a package for them; names without one are keywords.

(in-package #:s-xml)

(define-condition xml-parser-error (error)
  ((message :initarg :message :initform "failed" :reader xml-parser-error-message :documentation "A format string.")
   (args :initarg :args :initform '() :reader xml-parser-error-args :documentation "Its arguments.")
   (stream :initarg :stream :initform nil :reader xml-parser-error-stream :documentation "What was read, or nil."))
  (:report (lambda (condition stream)
             (let ((source (xml-parser-error-stream condition)))
               (format stream "XML parser ~?~@[ near stream position ~d~]."
                       (xml-parser-error-message condition) (xml-parser-error-args condition)
                       (and source (ignore-errors (file-position source)))))))
  (:documentation "A text that is not XML."))

(defun refuse (message args &optional stream)
  (error 'xml-parser-error :message message :args args :stream stream))

(defvar *ignore-namespaces* nil "Whether a colon in a name means nothing, and all names are keywords.")
(defvar *require-existing-symbols* nil "Whether a name for which there is no symbol yet is an error.")
(defvar *auto-export-symbols* t "Whether packages of namespaces export the symbols that are made in them.")
(defvar *auto-create-namespace-packages* t "Whether a prefix that has no package yet gets one.")

(defclass xml-namespace ()
  ((uri :initarg :uri :reader get-uri :documentation "What tells it from others, a string.")
   (prefix :initarg :prefix :reader get-prefix :documentation "How its names are written, a string; empty for none.")
   (package :initarg :package :reader get-package :documentation "Where its symbols are."))
  (:documentation "A vocabulary of XML."))

(defmethod print-object ((namespace xml-namespace) stream)
  (print-unreadable-object (namespace stream :type t :identity t)
    (format stream "~a - ~a" (get-prefix namespace) (get-uri namespace))))

(defvar *registered* (make-hash-table :test 'equal) "The namespaces, by their URIs.")

(defun find-namespace (uri)
  "The namespace that is registered under URI, or nil."
  (values (gethash uri *registered*)))

(defun namespace-package (designator)
  "The package of that name. It is made if that is allowed; else there is an error."
  (or (find-package designator)
      (if *auto-create-namespace-packages*
          (make-package designator :use '())
          (refuse "cannot find package ~s for a namespace" (list designator)))))

(defun register-namespace (uri prefix package)
  "The namespace of URI, whose names are printed with PREFIX and are symbols of PACKAGE (a name of one that need not be there yet)."
  (setf (gethash uri *registered*)
        (make-instance 'xml-namespace :uri uri :prefix prefix :package (namespace-package package))))

(defvar *local-namespace* (register-namespace "local" "" :keyword) "Of names that have no namespace.")

(defvar *namespaces* (list (cons "xml" (register-namespace "http://www.w3.org/XML/1998/namespace" "xml" :xml)) (cons "" *local-namespace*))
  "What prefixes stand for where the parser is: an alist of namespaces, the innermost first.")

(defun split-identifier (identifier)
  "Two values: the prefix of the string IDENTIFIER, or nil, and the rest."
  (let ((colon (position #\: identifier)))
    (if colon
        (values (subseq identifier 0 colon) (subseq identifier (1+ colon)))
        (values nil identifier))))

(defun symbol-of (name package)
  "The symbol of NAME in PACKAGE, made and exported as the variables above say."
  (multiple-value-bind (symbol status) (find-symbol name package)
    (cond (status symbol)
          (*require-existing-symbols* (refuse "cannot find existing symbol for name ~s" (list name)))
          (t (let ((symbol (intern name package)))
               (when (and *auto-export-symbols* (not (eq package (find-package :keyword))))
                 (export symbol package))
               symbol)))))

(defun resolve-identifier (identifier namespaces &optional as-attribute)
  "The symbol for the string IDENTIFIER where NAMESPACES hold.
AS-ATTRIBUTE: whether a name without prefix is local, whatever the default namespace is."
  (if *ignore-namespaces*
      (symbol-of identifier (find-package :keyword))
      (multiple-value-bind (prefix name) (split-identifier identifier)
        (cond ((and as-attribute (member prefix '(nil "xmlns") :test #'equal))
               (symbol-of identifier (get-package *local-namespace*)))
              (t
               (let ((namespace (cdr (assoc (or prefix "") namespaces :test #'string=))))
                 (unless namespace
                   (refuse "namespace not found for prefix ~s" (list prefix)))
                 (symbol-of name (get-package namespace))))))))

(defun free-prefix ()
  "A prefix for a namespace that has none where it is declared: ns-0, or the first with a number for which there is no package."
  (loop for count from 0
        for prefix = (format nil "ns-~d" count)
        unless (find-package (string-upcase prefix)) return prefix))

(defun extend-namespaces (attributes namespaces)
  "NAMESPACES with those before them that ATTRIBUTES declare, an alist of strings, by `xmlns` and `xmlns:PREFIX`."
  (dolist (attribute attributes namespaces)
    (destructuring-bind (name . uri) attribute
      (multiple-value-bind (prefix rest) (split-identifier name)
        (let ((declared (cond ((equal prefix "xmlns") rest)
                              ((string= name "xmlns") ""))))
          (when declared
            (push (cons declared (or (find-namespace uri)
                                     (let ((prefix (if (string= declared "") (free-prefix) declared)))
                                       (register-namespace uri prefix (if (string= declared "") (string-upcase prefix) prefix)))))
                  namespaces)))))))

(defun prefix-of (symbol)
  "The prefix of the namespace that SYMBOL is a name of, as it is declared where the printer is; nil for none."
  (let ((package (symbol-package symbol)))
    (or (car (find package *namespaces* :key (lambda (binding) (get-package (cdr binding)))))
        (loop for namespace being the hash-values of *registered*
              when (eq (get-package namespace) package) return (get-prefix namespace)))))

(defun print-identifier (identifier stream &optional as-attribute)
  "Write the name IDENTIFIER, a symbol or a string, with the prefix of its namespace. One of other packages is written without."
  (declare (ignore as-attribute))
  (let ((prefix (and (symbolp identifier) (not *ignore-namespaces*) (prefix-of identifier))))
    (when (plusp (length prefix))
      (write-string prefix stream)
      (write-char #\: stream))
    (write-string (string identifier) stream)))
