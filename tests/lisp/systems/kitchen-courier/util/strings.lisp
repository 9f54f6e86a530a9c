;;;; Strings: splitting, names in two spellings, tables of text.

(in-package #:courier-util)

(defun split (string &key (separator #\Space) (omit-empty t) limit)
  "The parts of STRING between SEPARATORs (a character, or a predicate), at most LIMIT of them."
  (let ((test (etypecase separator
                (character (curry #'char= separator))
                (function separator)
                (symbol (symbol-function separator)))))
    (loop with start = 0 and count = 0
          for end = (and (or (null limit) (< count (1- limit))) (position-if test string :start start))
          for part = (subseq string start end)
          unless (and omit-empty (zerop (length part)))
            collect part and do (incf count)
          while end
          do (setf start (1+ end)))))

(defun join (things &optional (separator ", ") (last separator))
  "THINGS as text with SEPARATOR between them and LAST before the last."
  (with-output-to-string (out)
    (loop for (thing . more) on things
          do (princ thing out)
          when more
            do (write-string (if (rest more) separator last) out))))

(defun pad (thing width &key (side :right) (with #\Space))
  (let* ((text (princ-to-string thing))
         (missing (max 0 (- width (length text))))
         (filling (make-string missing :initial-element with)))
    (ecase side
      (:right (concatenate 'string text filling))
      (:left (concatenate 'string filling text))
      (:both (let ((left (floor missing 2)))
               (concatenate 'string (subseq filling 0 left) text (subseq filling left)))))))

(defun kebab-to-camel (name)
  (let ((up nil))
    (map 'string #'identity
         (loop for char across (string-downcase name)
               if (char= char #\-)
                 do (setf up t)
               else
                 collect (if up (char-upcase char) char)
                 and do (setf up nil)))))

(defun camel-to-kebab (name)
  (with-output-to-string (out)
    (loop for previous = nil then char
          for char across name
          when (and previous (upper-case-p char) (not (upper-case-p previous)))
            do (write-char #\- out)
          do (write-char (char-downcase char) out))))

(defun read-pairs (text)
  "\"a=1; b = two ;flag\" as an alist; integers, ratios and floats are numbers, a name alone is true."
  (flet ((value (string)
           (let ((string (string-trim '(#\Space #\Tab) string)))
             (cond ((and (plusp (length string))
                         (every (lambda (char) (or (digit-char-p char) (find char "+-./"))) string)
                         (some #'digit-char-p string))
                    (let ((*read-eval* nil) (*read-default-float-format* 'double-float))
                      (read-from-string string)))
                   (t string)))))
    (loop for part in (split text :separator #\;)
          for (key value) = (split part :separator #\= :limit 2)
          for name = (intern (string-upcase (string-trim " " key)) :keyword)
          collect (cons name (if value (value value) t)))))

(defun caesar (text shift)
  (flet ((turn (char base) (code-char (+ base (mod (+ shift (- (char-code char) base)) 26)))))
    (map 'string (lambda (char)
                   (cond ((char<= #\a char #\z) (turn char #.(char-code #\a)))
                         ((char<= #\A char #\Z) (turn char #.(char-code #\A)))
                         (t char)))
         text)))

(defun wrap-words (text width)
  "TEXT as a list of lines no longer than WIDTH, if words allow."
  (let ((lines '()) (line (make-array width :element-type 'character :adjustable t :fill-pointer 0)))
    (flet ((finish () (when (plusp (fill-pointer line))
                        (push (copy-seq line) lines)
                        (setf (fill-pointer line) 0))))
      (dolist (word (split text) (progn (finish) (nreverse lines)))
        (when (> (+ (length line) 1 (length word)) width) (finish))
        (unless (zerop (length line)) (vector-push-extend #\Space line))
        (loop for char across word do (vector-push-extend char line))))))

(defmacro string-case (value &body clauses)
  "CASE by STRING-EQUAL."
  (once-only (value)
    `(cond ,@(loop for (keys . body) in clauses
                   collect (if (member keys '(t otherwise))
                               `(t ,@body)
                               `((or ,@(loop for key in (if (listp keys) keys (list keys))
                                             collect `(string-equal ,value ,key)))
                                 ,@body))))))

(defvar *sides* nil "How the columns of a table are aligned.")

(defun table (header rows &key (stream *standard-output*) alignment)
  "Print ROWS under HEADER, each column as wide as its widest cell."
  (let* ((all (cons header (mapcar (lambda (row) (mapcar #'princ-to-string row)) rows)))
         (widths (apply #'mapcar (lambda (&rest cells) (reduce #'max cells :key #'length)) all)))
    (labels ((print-row (row)
               (format stream "~&|~{ ~A |~}~%"
                       (loop for cell in row
                             for width in widths
                             for sides = *sides* then (rest sides)
                             for side = (or (first sides) :left)
                             collect (pad cell width :side side))))
             (rule () (format stream "~&+~{~V,,,'-<~>+~}~%" (mapcar (lambda (width) (+ 2 width)) widths)))
             (rows (those &aux (*sides* alignment))
               (mapc #'print-row those)
               (rule)))
      (declare (dynamic-extent #'rule))
      (rule)
      (rows (list (first all)))
      (rows (rest all))
      (length rows))))
