;;;; The tests of each package, by name and by tag.

(in-package #:lisp-unit)

(defvar *tests* (make-hash-table :test #'eq)
  "Package -> table of its tests by name.")

(defvar *tags* (make-hash-table :test #'eq)
  "Package -> table of the names of its tests by tag.")

(defclass unit-test ()
  ((name :initarg :name :reader name)
   (doc :initarg :doc :reader doc)
   (code :initarg :code :reader code)
   (thunk :initarg :thunk :reader thunk)
   (place :initarg :place :reader place))
  (:documentation "A test: its forms, and the function that they are compiled to. PLACE is where it was defined."))

(defun the-package (designator)
  "The package that DESIGNATOR means; an unknown one is an error."
  (or (find-package designator)
      (error "The name ~S does not designate any package." designator)))

(defun package-table (tables package &optional create)
  "The table of PACKAGE in TABLES, NIL when it has none and is not to get one."
  (let ((package (the-package package)))
    (or (gethash package tables)
        (when create (setf (gethash package tables) (make-hash-table))))))

(defun test-table (package)
  "The tests of PACKAGE; that there are none is a warning."
  (or (package-table *tests* package)
      (warn "No tests defined for package: ~A" (package-name (the-package package)))))

(defun tag-table (package)
  "The tags of PACKAGE; that there are none is a warning."
  (or (package-table *tags* package)
      (warn "No tags defined for package: ~A" (package-name (the-package package)))))

(defmacro define-test (name &body body)
  "Define the test NAME of the current package. Before its forms BODY may have a documentation string and (:TAG . TAGS)."
  (unless (and name (symbolp name) (not (keywordp name)))
    (error "DEFINE-TEST: the name of a test is a symbol, not ~S." name))
  (let ((doc (when (and (stringp (first body)) (rest body)) (pop body)))
        (tags (when (and (consp (first body)) (member (caar body) '(:tag :tags))) (rest (pop body)))))
    ;; the documentation may also follow the tags
    (when (and (null doc) (stringp (first body)) (rest body))
      (setf doc (pop body)))
    `(enter-test ',name ',doc ',tags ',body (lambda () ,@body) (cramhy::source-position))))

(defun enter-test (name doc tags code thunk place)
  "Keep a test of the current package, in place of an earlier one of that name. Returns NAME."
  (forget-tags (list name) *package*)
  (setf (gethash name (package-table *tests* *package* t))
        (make-instance 'unit-test :name name :doc doc :code code :thunk thunk :place place))
  (let ((table (when tags (package-table *tags* *package* t))))
    (dolist (tag tags)
      (setf (gethash tag table) (append (gethash tag table) (list name)))))
  name)

(defun forget-tags (names package)
  "Take the tests NAMES out of all tags of PACKAGE."
  (let ((table (package-table *tags* package)))
    (when table
      (maphash (lambda (tag tests)
                 (setf (gethash tag table) (remove-if (lambda (name) (member name names)) tests)))
               table))))

(defun find-test (name package)
  (let ((table (test-table package)))
    (when table (gethash name table))))

(defun list-tests (&optional (package *package*))
  "The names of the tests of PACKAGE."
  (let ((table (test-table package)))
    (when table (loop for name being the hash-keys of table collect name))))

(defun test-documentation (name &optional (package *package*))
  "The documentation of the test NAME, and whether there is such a test."
  (let ((test (find-test name package)))
    (if test (values (doc test) t) (warn "No code defined for test ~A in package ~A." name (package-name (the-package package))))))

(defun test-code (name &optional (package *package*))
  "The forms of the test NAME."
  (let ((test (find-test name package)))
    (if test (code test) (warn "No code defined for test ~A in package ~A." name (package-name (the-package package))))))

(defun remove-tests (&optional (names :all) (package *package*))
  "Forget the tests NAMES of PACKAGE, or :ALL."
  (if (eq names :all)
      (if (package-table *tests* package)
          (progn (remhash (the-package package) *tests*) (remhash (the-package package) *tags*))
          (warn "No tests defined for package: ~A" (package-name (the-package package))))
      (let ((table (test-table package)))
        (when table
          (dolist (name names)
            (unless (remhash name table)
              (warn "No test ~A in package ~A to remove." name (package-name (the-package package)))))
          (forget-tags names package))))
  nil)

(defun list-tags (&optional (package *package*))
  "The tags of the tests of PACKAGE."
  (let ((table (tag-table package)))
    (when table (loop for tag being the hash-keys of table collect tag))))

(defun tagged-tests (tags &optional (package *package*))
  "The names of the tests that have one of TAGS, or any tag with :ALL."
  (let ((table (tag-table package)) (names '()))
    (when table
      (dolist (tag (if (eq tags :all) (list-tags package) tags) names)
        (multiple-value-bind (tests there) (gethash tag table)
          (if there
              (dolist (test tests) (unless (member test names) (setf names (append names (list test)))))
              (warn "No tests tagged with ~S." tag)))))))

(defun remove-tags (&optional (tags :all) (package *package*))
  "Forget TAGS, or :ALL, but not the tests that have them."
  (let ((table (tag-table package)))
    (when table
      (if (eq tags :all)
          (remhash (the-package package) *tags*)
          (dolist (tag tags)
            (unless (remhash tag table)
              (warn "No tag ~S in package ~A to remove." tag (package-name (the-package package))))))))
  nil)
