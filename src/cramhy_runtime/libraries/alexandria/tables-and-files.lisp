;;;; Hash tables, arrays, files and streams.

(in-package #:alexandria)

;;; ------------------------------------------------------------------------------------------------------------ hash tables

(defun maphash-keys (function table)
  "Call FUNCTION with each key of TABLE."
  (maphash (lambda (key value) (declare (ignore value)) (funcall function key)) table))

(defun maphash-values (function table)
  "Call FUNCTION with each value of TABLE."
  (maphash (lambda (key value) (declare (ignore key)) (funcall function value)) table))

;;; The lists are in the order in which the library makes them: what was entered last comes first.

(defun hash-table-keys (table)
  "The list of the keys of TABLE."
  (let ((keys nil)) (maphash (lambda (key value) (declare (ignore value)) (push key keys)) table) keys))

(defun hash-table-values (table)
  "The list of the values of TABLE."
  (let ((all nil)) (maphash (lambda (key value) (declare (ignore key)) (push value all)) table) all))

(defun hash-table-alist (table)
  "The association list of the entries of TABLE."
  (let ((alist nil)) (maphash (lambda (key value) (push (cons key value) alist)) table) alist))

(defun hash-table-plist (table)
  "The property list of the entries of TABLE."
  (let ((plist nil)) (maphash (lambda (key value) (setf plist (list* key value plist))) table) plist))

(defun alist-hash-table (alist &rest hash-table-initargs)
  "A hash table with the pairs of ALIST; of equal keys the first counts."
  (let ((table (apply #'make-hash-table hash-table-initargs)))
    (loop for (key . value) in alist do (ensure-gethash key table value))
    table))

(defun plist-hash-table (plist &rest hash-table-initargs)
  "A hash table with the properties of PLIST; of equal keys the first counts."
  (let ((table (apply #'make-hash-table hash-table-initargs)))
    (loop for (key value) on plist by #'cddr do (ensure-gethash key table value))
    table))

(defun copy-hash-table (table &key key test size rehash-size rehash-threshold)
  "A copy of TABLE; KEY is applied to each value on the way."
  (let ((copy (make-hash-table :test (or test (hash-table-test table))
                               :size (or size (hash-table-size table))
                               :rehash-size (or rehash-size (hash-table-rehash-size table))
                               :rehash-threshold (or rehash-threshold (hash-table-rehash-threshold table))))
        (key (if key (ensure-function key) #'identity)))
    (maphash (lambda (name value) (setf (gethash name copy) (funcall key value))) table)
    copy))

(defun copy-array (array &key (element-type (array-element-type array))
                           (fill-pointer (and (array-has-fill-pointer-p array) (fill-pointer array)))
                           (adjustable (adjustable-array-p array)))
  "A copy of ARRAY that shares nothing with it."
  (let ((copy (make-array (array-dimensions array) :element-type element-type :fill-pointer fill-pointer :adjustable adjustable)))
    (dotimes (index (array-total-size array) copy)
      (setf (row-major-aref copy index) (row-major-aref array index)))))

;;; ------------------------------------------------------------------------------------------------------ files and streams

(defmacro with-input-from-file ((stream-name file-name &rest args &key (direction nil direction-p) &allow-other-keys) &body body)
  "WITH-OPEN-FILE for reading."
  (declare (ignore direction))
  (when direction-p
    (error "Can't specify :DIRECTION for WITH-INPUT-FROM-FILE."))
  `(with-open-file (,stream-name ,file-name :direction :input ,@args) ,@body))

(defmacro with-output-to-file ((stream-name file-name &rest args &key (direction nil direction-p) &allow-other-keys) &body body)
  "WITH-OPEN-FILE for writing."
  (declare (ignore direction))
  (when direction-p
    (error "Can't specify :DIRECTION for WITH-OUTPUT-TO-FILE."))
  `(with-open-file (,stream-name ,file-name :direction :output ,@args) ,@body))

(defun read-stream-content-into-string (stream &key (buffer-size 4096))
  "The characters that are left in STREAM."
  (check-type buffer-size (integer 1))
  (let ((buffer (make-string buffer-size)))
    (with-output-to-string (out)
      (loop for count = (read-sequence buffer stream)
            do (write-sequence buffer out :start 0 :end count)
            while (= count buffer-size)))))

(defun read-file-into-string (pathname &key (buffer-size 4096) external-format)
  "The text of the file PATHNAME."
  (with-open-file (stream pathname :direction :input :external-format (or external-format :default))
    (read-stream-content-into-string stream :buffer-size buffer-size)))

(defun write-string-into-file (string pathname &key (if-exists :error) if-does-not-exist external-format)
  "Make the file PATHNAME with the text STRING."
  (with-open-file (stream pathname :direction :output :if-exists if-exists
                                   :if-does-not-exist (or if-does-not-exist (if (member if-exists '(:overwrite :append)) :error :create))
                                   :external-format (or external-format :default))
    (write-sequence string stream)))

(defun read-stream-content-into-byte-vector (stream &key ((:%length length)) (initial-size 4096))
  "The bytes that are left in STREAM, or the next LENGTH of them."
  (let ((buffer (make-array (or length initial-size) :element-type '(unsigned-byte 8))) (bytes '()))
    (loop for count = (read-sequence buffer stream)
          do (push (subseq buffer 0 count) bytes)
          while (and (null length) (= count (length buffer))))
    (apply #'concatenate '(vector (unsigned-byte 8)) (nreverse bytes))))

(defun read-file-into-byte-vector (pathname)
  "The bytes of the file PATHNAME."
  (with-open-file (stream pathname :direction :input :element-type '(unsigned-byte 8))
    (read-stream-content-into-byte-vector stream)))

(defun write-byte-vector-into-file (bytes pathname &key (if-exists :error) if-does-not-exist)
  "Make the file PATHNAME with the vector BYTES."
  (with-open-file (stream pathname :direction :output :element-type '(unsigned-byte 8) :if-exists if-exists
                                   :if-does-not-exist (or if-does-not-exist (if (member if-exists '(:overwrite :append)) :error :create)))
    (write-sequence bytes stream)))

(defun copy-stream (input output &key (element-type (stream-element-type input)) (buffer-size 4096)
                                   (buffer (make-array buffer-size :element-type element-type))
                                   (start 0) end finish-output)
  "Copy what INPUT has from START to END to OUTPUT. Returns how many elements these were."
  (when (and end (< end start))
    (error "END is smaller than START in ~S" 'copy-stream))
  (loop repeat start
        do (if (eq element-type 'character) (read-char input) (read-byte input)))
  (let ((copied 0))
    (loop for wanted = (if end (min (length buffer) (- end start copied)) (length buffer))
          for count = (read-sequence buffer input :end wanted)
          do (write-sequence buffer output :end count)
             (incf copied count)
          while (and (plusp wanted) (= count wanted)))
    (when (and end (< copied (- end start)))
      (error "~@<not enough data in ~S: ~D elements wanted, ~D found~:@>" input (- end start) copied))
    (when finish-output (finish-output output))
    copied))

(defun copy-file (from to &key (if-to-exists :supersede) (element-type '(unsigned-byte 8)) finish-output)
  "Copy the file FROM to TO. Returns the number of elements."
  (with-open-file (input from :direction :input :element-type element-type)
    (with-open-file (output to :direction :output :element-type element-type :if-exists if-to-exists)
      (copy-stream input output :element-type element-type :finish-output finish-output))))
