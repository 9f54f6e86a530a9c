;;;; The parser reads one element from a stream of characters and calls three hooks, which hand on a value from one to the next, the seed.
;;;; What stands before the element (declarations, comments, a document type) is passed over. Nothing is validated.

(in-package #:s-xml)

(defun standard-entities ()
  (let ((entities (make-hash-table :test 'equal)))
    (loop for (name . text) in '(("lt" . "<") ("gt" . ">") ("amp" . "&") ("apos" . "'") ("quot" . "\"") ("nbsp" . " "))
          do (setf (gethash name entities) text))
    entities))

(defclass xml-parser-state ()
  ((entities :initarg :entities :initform (standard-entities) :accessor get-entities
             :documentation "What stands for what: a hash table of strings by the names of entities.")
   (seed :initarg :seed :initform nil :accessor get-seed :documentation "What the first hook gets.")
   (new-element-hook :initarg :new-element-hook :accessor get-new-element-hook
                     :initform (lambda (name attributes seed) (declare (ignore name attributes)) seed)
                     :documentation "Called with name, attributes and seed where an element begins. It gives the seed of what is in it.")
   (finish-element-hook :initarg :finish-element-hook :accessor get-finish-element-hook
                        :initform (lambda (name attributes parent-seed seed) (declare (ignore name attributes parent-seed)) seed)
                        :documentation "Called with name, attributes, the seed before the element and the one at its end.")
   (text-hook :initarg :text-hook :accessor get-text-hook
              :initform (lambda (string seed) (declare (ignore string)) seed)
              :documentation "Called with a text and the seed."))
  (:documentation "How a text is parsed: hooks, the first seed, entities. Attributes are an alist of names and strings, the last first."))

;;; Characters.

(declaim (inline space-p))
(defun space-p (character)
  (case character ((#\Space #\Newline #\Tab #\Return #\Page) t)))

(defun name-character-p (character)
  (or (alphanumericp character) (find character ":_-.")))

(defun skip-spaces (stream)
  "The next character that is not space, which stays in the stream; nil at its end."
  (loop for character = (peek-char nil stream nil)
        while (and character (space-p character)) do (read-char stream)
        finally (return character)))

(defun expect (character stream message)
  (unless (eql (read-char stream nil) character)
    (refuse message '() stream)))

(defun read-name (stream)
  "The letters, digits and marks that come next, as a string, which may be empty."
  (with-output-to-string (name)
    (loop for character = (read-char stream nil)
          while (and character (name-character-p character)) do (write-char character name)
          finally (when character (unread-char character stream)))))

(defun next-character (stream inside)
  "The next character, which is read. At the end of the stream an error that says INSIDE what it is."
  (or (read-char stream nil) (refuse inside '() stream)))

(defun skip-past (end stream inside)
  "Read up to the text END of two characters, and over it. INSIDE: what an early end of the stream is."
  (loop for before = nil then character
        for character = (next-character stream inside)
        until (and (eql before (char end 0)) (char= character (char end 1)))))

;;; Entities.

(defun entity-text (name state stream)
  (or (gethash name (get-entities state))
      (let ((code (and (> (length name) 1) (char= (char name 0) #\#)
                       (if (char-equal (char name 1) #\x)
                           (ignore-errors (parse-integer name :start 2 :radix 16))
                           (ignore-errors (parse-integer name :start 1))))))
        (and code (< code char-code-limit) (string (code-char code))))
      (if (and (plusp (length name)) (char= (char name 0) #\#))
          (refuse "encountered incorrect entity &~s;" (list name) stream)
          (refuse "encountered unknown entity &~s;" (list name) stream))))

(defun read-entity (state stream)
  "What an entity stands for whose `&` was read."
  (entity-text (with-output-to-string (name)
                 (loop for character = (next-character stream "encountered eof before end of entity")
                       until (char= character #\;)
                       do (when (or (space-p character) (find character "<&"))
                            (refuse "encountered incorrect entity" '() stream))
                          (write-char character name)))
               state stream))

(defun read-text (end state stream)
  "The text up to the character END, or to the end of the stream, with entities replaced, and whether all of it is spaces.
END stays in the stream."
  (let ((blank t))
    (values (with-output-to-string (text)
              (loop for character = (read-char stream nil)
                    until (or (null character) (char= character end))
                    do (cond ((char= character #\&)
                              (setf blank nil)
                              (write-string (read-entity state stream) text))
                             (t
                              (when (and blank (not (space-p character))) (setf blank nil))
                              (write-char character text)))
                    finally (when character (unread-char character stream))))
            blank)))

;;; What is no element.

(defun skip-comment (stream)
  "Read a comment whose `<!--` was read. Two hyphens end it."
  (skip-past "--" stream "encountered unexpected eof for comment")
  (expect #\> stream "expected > ending comment"))

(defun skip-document-type (stream)
  "Read a document type whose `<!` was read, with all that is declared in it."
  (loop with depth = 1
        for character = (next-character stream "encountered unexpected eof in document type")
        do (case character
             (#\< (incf depth))
             (#\> (when (zerop (decf depth)) (return)))
             ((#\" #\') (loop until (char= (next-character stream "encountered eof before end of string") character))))))

(defun read-cdata (stream)
  "The text of a CDATA section of which `<![` was read."
  (loop for character across "CDATA[" do (expect character stream "expected CDATA["))
  (with-output-to-string (text)
    (loop with brackets = 0
          for character = (next-character stream "encountered unexpected eof in text")
          do (case character
               (#\] (incf brackets))
               (t (when (and (char= character #\>) (>= brackets 2))
                    (loop repeat (- brackets 2) do (write-char #\] text))
                    (return))
                  (loop repeat brackets do (write-char #\] text))
                  (setf brackets 0)
                  (write-char character text))))))

(defun read-markup (stream)
  "What begins with `<` and is no element, of which `<` was read: a text if it is CDATA, nil if it was passed over, T if an element comes."
  (case (peek-char nil stream nil)
    (#\? (skip-past "?>" stream "encountered unexpected eof in processing instruction") nil)
    (#\! (read-char stream)
     (case (peek-char nil stream nil)
       (#\- (read-char stream) (expect #\- stream "expected - starting comment") (skip-comment stream) nil)
       (#\[ (read-char stream) (read-cdata stream))
       (t (skip-document-type stream) nil)))
    (t t)))

;;; Elements.

(defun read-attributes (state stream)
  "The attributes that come next, an alist of strings, the last first."
  (let ((attributes '()))
    (loop
      (let ((next (skip-spaces stream)))
        (when (find next "/>")
          (return attributes))
        (let ((name (read-name stream)))
          (unless (eql (skip-spaces stream) #\=)
            (refuse "expected =" '() stream))
          (read-char stream)
          (let ((delimiter (skip-spaces stream)))
            (unless (member delimiter '(#\" #\'))
              (refuse "expected string delimiter" '() (progn (read-char stream nil) stream)))
            (read-char stream)
            (push (cons name (read-text delimiter state stream)) attributes)
            (next-character stream "encountered eof before end of string")))))))

(defun resolved-attributes (attributes)
  (loop for (name . value) in attributes collect (cons (resolve-identifier name *namespaces* t) value)))

(defun parse-element (stream state seed)
  "The seed after the element whose `<` was read."
  (let* ((written (read-name stream))
         (attributes (read-attributes state stream))
         (*namespaces* (if *ignore-namespaces* *namespaces* (extend-namespaces attributes *namespaces*)))
         (name (resolve-identifier written *namespaces*))
         (attributes (resolved-attributes attributes))
         (inner (funcall (get-new-element-hook state) name attributes seed)))
    (if (char= (read-char stream) #\/)
        (expect #\> stream "expected >")
        (setf inner (parse-content stream state name written inner)))
    (funcall (get-finish-element-hook state) name attributes seed inner)))

(defun parse-content (stream state name written seed)
  "The seed after all that is in the element NAME, WRITTEN so in the text, and after its end. Text of spaces alone counts if nothing else
is there."
  (let ((alone t))
    (loop
      (multiple-value-bind (text blank) (read-text #\< state stream)
        (unless (read-char stream nil)
          (if (plusp (length text))
              (refuse "encountered unexpected eof in text" '() stream)
              (refuse "encountered unexpected eof handling ~a" (list name))))
        (let ((ending (eql (peek-char nil stream nil) #\/)))
          (when (and (plusp (length text)) (or (not blank) (and ending alone)))
            (setf seed (funcall (get-text-hook state) text seed)))
          (when ending
            (read-char stream)
            (finish-element stream name written)
            (return seed))))
      (setf alone nil)
      (let ((markup (read-markup stream)))
        (cond ((stringp markup) (setf seed (funcall (get-text-hook state) markup seed)))
              (markup (setf seed (parse-element stream state seed))))))))

(defun finish-element (stream name written)
  "Read the end of the element NAME, WRITTEN so, of which `</` was read."
  (let ((ending (read-name stream)))
    (unless (string= ending written)
      (refuse "found <~a> not matched by </~a> but by <~a>" (list name name (resolve-identifier ending *namespaces*)) stream)))
  (skip-spaces stream)
  (unless (char= (read-char stream) #\>)
    (refuse "expected >" '() stream)))

(defun start-parse-xml (stream &optional (state (make-instance 'xml-parser-state)))
  "The last seed that the hooks of STATE gave for the next element of the character STREAM. At its end it is the first seed."
  (loop
    (unless (skip-spaces stream)
      (return (get-seed state)))
    (expect #\< stream "expected <")
    (when (eq (read-markup stream) t)
      (return (parse-element stream state (get-seed state))))))
