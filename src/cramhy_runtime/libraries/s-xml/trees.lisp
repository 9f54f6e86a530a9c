;;;; Three kinds of trees: :LXML is ((name attribute value ...) child ...), :SXML is (name (:@ (attribute value) ...) child ...), and
;;;; :XML-STRUCT a structure. Each is made by hooks of the parser and printed as (name, attributes, children).

(in-package #:s-xml)

(defstruct (xml-element (:constructor make-xml-element (&key name attributes children)))
  "An element. name: a symbol. attributes: an alist of symbols and strings. children: strings and elements."
  name attributes children)

(defun new-xml-element (name &rest children)
  "An element of that NAME, without attributes."
  (make-xml-element :name name :children children))

(defun first-xml-element-child (xml-element)
  "The first child of XML-ELEMENT, a text or an element; nil if it has none."
  (first (xml-element-children xml-element)))

(defun xml-element-attribute (xml-element key)
  "The string that the attribute KEY has, or nil."
  (cdr (assoc key (xml-element-attributes xml-element))))

(defun (setf xml-element-attribute) (value xml-element key)
  "Give the attribute KEY a value. One that is not there is made."
  (let ((there (assoc key (xml-element-attributes xml-element))))
    (if there
        (setf (cdr there) value)
        (push (cons key value) (xml-element-attributes xml-element)))
    value))

;;; Parsing.

(defun parsed (stream element)
  "The tree of the next element of STREAM. ELEMENT makes a node of a name, attributes (an alist, the last first) and children."
  (first (start-parse-xml stream
                          (make-instance 'xml-parser-state
                                         :new-element-hook (constantly '())
                                         :finish-element-hook (lambda (name attributes parent-seed seed)
                                                                (cons (funcall element name attributes (reverse seed)) parent-seed))
                                         :text-hook #'cons))))

(defgeneric parse-xml-dom (stream output-type)
  (:documentation "The tree of the next element of STREAM, of the kind OUTPUT-TYPE; nil if there is none.")
  (:method (stream (output-type (eql :lxml)))
    (parsed stream (lambda (name attributes children)
                     (cond (attributes
                            (cons (cons name (loop for (key . value) in (reverse attributes) collect key collect value)) children))
                           (children (cons name children))
                           (t name)))))
  (:method (stream (output-type (eql :sxml)))
    (parsed stream (lambda (name attributes children)
                     (cons name (if attributes
                                    (cons (cons :@ (loop for (key . value) in (reverse attributes) collect (list key value))) children)
                                    children)))))
  (:method (stream (output-type (eql :xml-struct)))
    (parsed stream (lambda (name attributes children)
                     (make-xml-element :name name :attributes attributes :children children)))))

(defun parse-xml (stream &key (output-type :lxml))
  "The tree of the next element of the character STREAM. OUTPUT-TYPE: :LXML, :SXML or :XML-STRUCT."
  (parse-xml-dom stream output-type))

(defun parse-xml-string (string &key (output-type :lxml))
  "The tree of the first element in STRING. OUTPUT-TYPE: :LXML, :SXML or :XML-STRUCT."
  (with-input-from-string (stream string)
    (parse-xml-dom stream output-type)))

(defun parse-xml-file (filename &key (output-type :lxml))
  "The tree of the first element in that file. OUTPUT-TYPE: :LXML, :SXML or :XML-STRUCT."
  (with-open-file (stream filename)
    (parse-xml-dom stream output-type)))

;;; Printing.

(defun print-string-xml (string stream &key (start 0) end)
  "Write the characters of STRING from START to END as text of XML: with entities for what is markup, and numbers beyond ASCII."
  (loop for index from start below (or end (length string))
        for character = (char string index)
        for code = (char-code character)
        do (case character
             (#\& (write-string "&amp;" stream))
             (#\< (write-string "&lt;" stream))
             (#\> (write-string "&gt;" stream))
             (#\" (write-string "&quot;" stream))
             ((#\Newline #\Tab #\Return) (write-char character stream))
             (t (if (<= 32 code 126)
                    (write-char character stream)
                    (format stream "&#x~:@(~x~);" code))))))

(defun indent-line (stream level)
  (terpri stream)
  (loop repeat (* 2 level) do (write-char #\Space stream)))

(defun declared-namespaces (attributes)
  "The namespaces that hold inside of an element with these ATTRIBUTES."
  (if *ignore-namespaces*
      *namespaces*
      (extend-namespaces (loop for (key . value) in attributes collect (cons (string key) value)) *namespaces*)))

(defun refuse-tree (dom kind)
  (error "Input not recognized as ~a ~s" kind dom))

(defun print-element (name attributes children print-child stream pretty level &aux (*namespaces* (declared-namespaces attributes)))
  "Write an element. ATTRIBUTES: an alist. PRINT-CHILD: a function of a child and a level; it is not asked about text."
  (flet ((print-any (child)
           (if (stringp child) (print-string-xml child stream) (funcall print-child child (1+ level)))))
    (write-char #\< stream)
    (print-identifier name stream)
    (loop for (key . value) in attributes
          do (write-char #\Space stream)
             (print-identifier key stream t)
             (write-string "=\"" stream)
             (print-string-xml value stream)
             (write-char #\" stream))
    (cond ((null children)
           (write-string "/>" stream))
          (t
           (write-char #\> stream)
           (cond ((or (not pretty) (and (stringp (first children)) (null (rest children))))
                  (mapc #'print-any children))
                 (t
                  (dolist (child children)
                    (indent-line stream level)
                    (print-any child))
                  (indent-line stream (max 0 (1- level)))))
           (write-string "</" stream)
           (print-identifier name stream)
           (write-char #\> stream)))))

(defgeneric print-xml-dom (dom input-type stream pretty level)
  (:documentation "Write the tree DOM, of the kind INPUT-TYPE. PRETTY: whether each child has a line, indented by LEVEL steps.")
  (:method (dom (input-type (eql :lxml)) stream pretty level)
    (flet ((print-child (child level) (print-xml-dom child :lxml stream pretty level)))
      (cond ((stringp dom) (print-string-xml dom stream))
            ((and dom (symbolp dom)) (print-element dom '() '() #'print-child stream pretty level))
            ((atom dom) (refuse-tree dom :lxml))
            ((and (consp (first dom)) (symbolp (caar dom)))
             (print-element (caar dom) (loop for (key value) on (cdar dom) by #'cddr collect (cons key value)) (rest dom)
                            #'print-child stream pretty level))
            ((symbolp (first dom)) (print-element (first dom) '() (rest dom) #'print-child stream pretty level))
            (t (refuse-tree dom :lxml)))))
  (:method (dom (input-type (eql :sxml)) stream pretty level)
    (flet ((print-child (child level) (print-xml-dom child :sxml stream pretty level)))
      (cond ((stringp dom) (print-string-xml dom stream))
            ((not (and (consp dom) (symbolp (first dom)))) (refuse-tree dom :sxml))
            (t
             (let ((given (and (consp (second dom)) (eq (first (second dom)) :@))))
               (print-element (first dom) (loop for (key value) in (and given (rest (second dom))) collect (cons key value))
                              (if given (cddr dom) (rest dom))
                              #'print-child stream pretty level))))))
  (:method (dom (input-type (eql :xml-struct)) stream pretty level)
    (flet ((print-child (child level) (print-xml-dom child :xml-struct stream pretty level)))
      (if (stringp dom)
          (print-string-xml dom stream)
          (print-element (xml-element-name dom) (xml-element-attributes dom) (xml-element-children dom)
                         #'print-child stream pretty level)))))

(defun print-xml (dom &key (stream t) pretty (input-type :lxml) (header))
  "Write the tree DOM to STREAM, T for standard output. PRETTY: each child has its line. HEADER: a text that comes first."
  (let ((stream (if (eq stream t) *standard-output* stream)))
    (when header (write-string header stream))
    (when pretty (terpri stream))
    (print-xml-dom dom input-type stream pretty 1)
    nil))

(defun print-xml-string (dom &key pretty (input-type :lxml))
  "The text of the tree DOM. PRETTY: each child has its line."
  (with-output-to-string (stream)
    (print-xml dom :stream stream :pretty pretty :input-type input-type)))
