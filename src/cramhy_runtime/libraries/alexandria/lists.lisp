;;;; Lists: their shape, association and property lists, and mapping.

(in-package #:alexandria)

;;; ------------------------------------------------------------------------------------------------------------------ shape

(defun list-shape (object)
  "Two values: :PROPER, :DOTTED or :CIRCULAR, or NIL when OBJECT is no list; and the number of its conses when they end."
  (if (not (listp object))
      (values nil 0)
      (loop with slow = object
            for fast = object then (cdr fast)
            for count from 0
            while (consp fast)
            do (when (and (plusp count) (evenp count))
                 (setf slow (cdr slow))
                 (when (eq slow fast) (return (values :circular nil))))
            finally (return (values (if (null fast) :proper :dotted) count)))))

(defun proper-list-p (object)
  "Whether OBJECT is a list that ends in NIL."
  (eq (list-shape object) :proper))

(defun circular-list-p (object)
  "Whether OBJECT is a list that comes back to itself."
  (eq (list-shape object) :circular))

(defun circular-tree-p (object)
  "Whether OBJECT is a tree with itself among its parts."
  (labels ((within (object above)
             (and (consp object)
                  (let ((above above))
                    (loop (cond ((not (consp object)) (return nil))
                                ((member object above :test #'eq) (return t)))
                          (push object above)
                          (when (within (car object) above) (return t))
                          (setf object (cdr object)))))))
    (within object '())))

(defun not-a-proper-list (object)
  (error 'type-error :datum object :expected-type 'list))

(defun proper-list-length (list)
  "The length of LIST, which must be a proper list."
  (multiple-value-bind (shape length) (list-shape list)
    (if (eq shape :proper) length (not-a-proper-list list))))

(defun lastcar (list)
  "The last element of LIST."
  (if (proper-list-p list)
      (car (last list))
      (not-a-proper-list (if (and (consp list) (not (circular-list-p list))) (cdr (last list)) list))))

(defun (setf lastcar) (object list)
  (if (proper-list-p list) (setf (car (last list)) object) (not-a-proper-list list)))

(defun make-circular-list (length &key initial-element)
  "A list of LENGTH elements that goes on with its beginning."
  (let ((list (make-list length :initial-element initial-element)))
    (nconc list list)))

(defun circular-list (&rest elements)
  "A list of ELEMENTS that goes on with its beginning."
  (let ((list (copy-list elements)))
    (nconc list list)))

(defun ensure-list (list)
  "LIST if it is one, else the list of it."
  (if (listp list) list (list list)))

(defun ensure-cons (cons)
  "CONS if it is one, else a cons of it and NIL."
  (if (consp cons) cons (cons cons nil)))

(defun ensure-car (thing)
  "The first element of THING if it is a cons, else THING."
  (if (consp thing) (car thing) thing))

(defun flatten (tree)
  "The atoms of TREE but NIL, as one list."
  (let ((found '()))
    (labels ((walk (tree)
               (loop while (consp tree)
                     do (walk (car tree))
                        (setf tree (cdr tree)))
               (when tree (push tree found))))
      (walk tree))
    (nreverse found)))

(defun setp (object &key (test #'eql) (key #'identity))
  "Whether OBJECT is a list in which no element stands twice."
  (and (listp object)
       (proper-list-p object)
       (loop for (element . rest) on object
             never (member (funcall key element) rest :test test :key key))))

(defun set-equal (list1 list2 &key (test #'eql) (key nil keyp))
  "Whether the lists have the same elements."
  (let ((keys1 (if keyp (mapcar key list1) list1))
        (keys2 (if keyp (mapcar key list2) list2)))
    (and (every (lambda (element) (member element keys2 :test test)) keys1)
         (every (lambda (element) (member element keys1 :test (lambda (a b) (funcall test b a)))) keys2))))

;;; --------------------------------------------------------------------------------------------------------------- mapping

(defun mappend (function &rest lists)
  "The results of MAPCAR, which are lists, appended."
  (loop for result in (apply #'mapcar function lists) append result))

(defun map-product (function list &rest more-lists)
  "The results of FUNCTION for each choice of one element from each list."
  (labels ((choose (lists chosen)
             (if (null lists)
                 (list (apply function (reverse chosen)))
                 (loop for element in (first lists) nconc (choose (rest lists) (cons element chosen))))))
    (choose (cons list more-lists) '())))

(defun first-number (start step)
  "START as a number of the type that START and STEP have together."
  (if (and (complexp step) (floatp start))
      (complex start (* 0 start))
      (+ start (- step step))))

(defun iota (n &key (start 0) (step 1))
  "N numbers from START on, STEP apart."
  (loop for index below n
        for number = (first-number start step) then (+ number step)
        collect number))

(defun map-iota (function n &key (start 0) (step 1))
  "Call FUNCTION with N numbers from START on, STEP apart. Returns N."
  (loop for index below n
        for number = (first-number start step) then (+ number step)
        do (funcall function number))
  n)

;;; ------------------------------------------------------------------------------------------- association and property lists

(defun alist-plist (alist)
  "The property list with the pairs of ALIST."
  (loop for (key . value) in alist collect key collect value))

(defun plist-alist (plist)
  "The association list with the properties of PLIST."
  (loop for (key value) on plist by #'cddr collect (cons key value)))

(defun assoc-value (alist key &key (test 'eql))
  "The value of KEY in ALIST, and its pair."
  (let ((pair (assoc key alist :test test)))
    (values (cdr pair) pair)))

(defun rassoc-value (alist key &key (test 'eql))
  "The key of the pair of ALIST whose value is KEY, and the pair."
  (let ((pair (rassoc key alist :test test)))
    (values (car pair) pair)))

(define-setf-expander assoc-value (alist key &key (test ''eql) &environment environment)
  (expand-pair-place alist key test environment 'assoc 'cdr 'acons 'assoc-value))

(define-setf-expander rassoc-value (alist key &key (test ''eql) &environment environment)
  (expand-pair-place alist key test environment 'rassoc 'car 'racons 'rassoc-value))

(defun racons (value key alist)
  "ALIST with the pair (KEY . VALUE) in front."
  (acons key value alist))

(eval-when (:compile-toplevel :load-toplevel :execute)
  (defun expand-pair-place (alist key test environment find part add reader)
    "The setf expansion of ASSOC-VALUE and RASSOC-VALUE: change the pair that there is, or put a new one in front."
    (multiple-value-bind (temporaries values stores setter getter) (get-setf-expansion alist environment)
      (with-gensyms (new-value key-value test-value list pair)
        (values (append temporaries (list list key-value test-value pair))
                (append values (list getter key test `(,find ,key-value ,list :test ,test-value)))
                (list new-value)
                `(if ,pair
                     (setf (,part ,pair) ,new-value)
                     (let ((,(first stores) (,add ,key-value ,new-value ,list)))
                       ,setter
                       ,new-value))
                `(,reader ,list ,key-value :test ,test-value))))))

(defun remove-from-plist (plist &rest keys)
  "PLIST without KEYS and their values."
  (loop for (key . rest) on plist by #'cddr
        do (unless rest (error "malformed plist: ~S" plist))
        unless (member key keys :test #'eq)
          collect key and collect (first rest)))

(defun delete-from-plist (plist &rest keys)
  "PLIST without KEYS and their values, of the same conses."
  (loop with previous = nil
        for rest = plist then (cddr rest)
        while rest
        do (unless (cdr rest) (error "malformed plist: ~S" rest))
           (cond ((not (member (car rest) keys :test #'eq)) (setf previous rest))
                 (previous (setf (cddr previous) (cddr rest)))
                 (t (setf plist (cddr rest)))))
  plist)

;;; ----------------------------------------------------------------------------------------------------------- lambda lists

(defun parse-ordinary-lambda-list (lambda-list &key (normalize t) allow-specializers (normalize-optional normalize)
                                                 (normalize-keyword normalize) (normalize-auxilary normalize))
  "The parts of LAMBDA-LIST as values: required, optional, &rest, keywords, whether others are allowed, &aux, whether &key stands
there. Normalized, an optional is (NAME INIT SUPPLIED-P), a keyword ((KEYWORD NAME) INIT SUPPLIED-P), an &aux (NAME INIT)."
  (let ((state '&required) (required '()) (optional '()) (rest nil) (keys '()) (allow nil) (aux '()) (keyp nil))
    (labels ((fail (control &rest arguments)
               (apply #'simple-program-error control arguments))
             (check-variable (element)
               (unless (and (symbolp element) (not (constantp element)))
                 (fail "Invalid variable in ordinary lambda-list:~%  ~S~%in:~%  ~S" element lambda-list))
               element)
             (after (element &rest states)
               (unless (member state states)
                 (fail "Misplaced ~S in ordinary lambda-list:~%  ~S" element lambda-list))
               (setf state element))
             (normal (element normalize)
               (destructuring-bind (name &optional init supplied) (ensure-list element)
                 (check-variable name)
                 (when supplied (check-variable supplied))
                 (if normalize (list name init supplied) element)))
             (normal-key (element)
               (destructuring-bind (name &optional init supplied) (ensure-list element)
                 (let ((pair (if (consp name) name (list (make-keyword name) name))))
                   (check-variable (second pair))
                   (when supplied (check-variable supplied))
                   (if normalize-keyword (list pair init supplied) element)))))
      (dolist (element lambda-list)
        (case element
          (&optional (after element '&required))
          (&rest (after element '&required '&optional))
          (&key (after element '&required '&optional :after-rest) (setf keyp t))
          (&allow-other-keys (after element '&key) (setf allow t state '&allow-other-keys))
          (&aux (after element '&required '&optional :after-rest '&key '&allow-other-keys))
          (t (when (member element lambda-list-keywords)
               (fail "Invalid lambda-list keyword ~S in ordinary lambda-list:~%  ~S" element lambda-list))
             (ecase state
               (&required (push (if (and allow-specializers (consp element)) element (check-variable element)) required))
               (&optional (push (normal element normalize-optional) optional))
               (&rest (setf rest (check-variable element) state :after-rest))
               (&key (push (normal-key element) keys))
               (&aux (push (if (and normalize-auxilary (not (consp element))) (list element nil) element) aux))
               ((:after-rest &allow-other-keys)
                (fail "Misplaced ~S in ordinary lambda-list:~%  ~S" element lambda-list)))))))
    (values (nreverse required) (nreverse optional) rest (nreverse keys) allow (nreverse aux) keyp)))
