;;;; SB-BSD-SOCKETS: sockets of the internet and of the machine, their options, names of hosts, and streams. The names and what they return are
;;;; those of chapter 18 of SBCL's manual; the calls themselves are Python's (sbcl/sockets.py), so a task that waits lets others go on.

(defpackage #:sb-bsd-sockets
  (:use #:common-lisp)
  (:nicknames #:sb-bsd-sockets-internal)
  (:export
   #:address-family-not-supported #:address-in-use-error #:bad-file-descriptor-error #:connection-refused-error
   #:get-host-by-address #:get-host-by-name #:get-protocol-by-name #:host-ent #:host-ent-address #:host-ent-address-type
   #:host-ent-addresses #:host-ent-aliases #:host-ent-name #:host-not-found-error #:inet-socket #:inet6-socket
   #:interrupted-error #:invalid-argument-error #:local-abstract-socket #:local-socket #:make-inet-address #:make-inet-socket
   #:make-inet6-address #:name-service-error #:netdb-internal-error #:netdb-success-error #:network-unreachable-error
   #:no-buffers-error #:no-recovery-error #:non-blocking-mode #:not-connected-error #:operation-in-progress
   #:operation-not-permitted-error #:operation-not-supported-error #:operation-timeout-error #:out-of-memory-error
   #:protocol-not-supported-error #:socket #:socket-accept #:socket-bind #:socket-close #:socket-connect #:socket-error
   #:socket-family #:socket-file-descriptor #:socket-listen #:socket-make-stream #:socket-name #:socket-open-p
   #:socket-peername #:socket-protocol #:socket-receive #:socket-send #:socket-shutdown #:socket-type
   #:socket-type-not-supported-error #:sockopt-bind-to-device #:sockopt-broadcast #:sockopt-bsd-compatible #:sockopt-debug
   #:sockopt-dont-route #:sockopt-keep-alive #:sockopt-oob-inline #:sockopt-pass-credentials #:sockopt-priority
   #:sockopt-receive-buffer #:sockopt-receive-low-water #:sockopt-reuse-address #:sockopt-send-buffer
   #:sockopt-send-low-water #:sockopt-tcp-keepcnt #:sockopt-tcp-keepidle #:sockopt-tcp-keepintvl #:sockopt-tcp-nodelay
   #:sockopt-type #:try-again-error #:unknown-protocol))

(in-package #:sb-bsd-sockets)

;;; ------------------------------------------------------------------------------------------------------------- conditions

(define-condition socket-error (error)
  ((errno :initform nil :initarg :errno :reader socket-error-errno)
   (text :initform nil :initarg :text :reader socket-error-text)
   (socket :initform nil :initarg :socket :reader socket-error-socket)
   (syscall :initform "outer space" :initarg :syscall :reader socket-error-syscall))
  (:report (lambda (condition stream)
             (format stream "Socket error in \"~A\": ~A (~A)"
                     (socket-error-syscall condition) (or (socket-error-errno condition) "unknown") (socket-error-text condition)))))

(define-condition name-service-error (socket-error) ())
(defun name-service-error-errno (condition) (socket-error-errno condition))
(defun name-service-error-symbol (condition) (type-of condition))
(define-condition unknown-protocol (error) ((name :initarg :name :reader unknown-protocol-name))
  (:report (lambda (condition stream) (format stream "Protocol not found: ~A" (unknown-protocol-name condition)))))

(defparameter *kinds* '() "List of (condition . names of numbers in C).")

(defmacro define-kinds (parent &rest kinds)
  `(progn ,@(loop for (name . numbers) in kinds
                  collect `(define-condition ,name (,parent) ())
                  collect `(push '(,name ,@numbers) *kinds*))))

(define-kinds socket-error
  (address-in-use-error eaddrinuse) (bad-file-descriptor-error ebadf) (connection-refused-error econnrefused)
  (interrupted-error eintr ewouldblock eagain) (invalid-argument-error einval) (no-buffers-error enobufs)
  (operation-not-supported-error eopnotsupp) (operation-not-permitted-error eperm) (operation-in-progress einprogress)
  (out-of-memory-error enomem) (protocol-not-supported-error eprotonosupport) (socket-type-not-supported-error esocktnosupport)
  (network-unreachable-error enetunreach) (operation-timeout-error etimedout) (not-connected-error enotconn)
  (address-family-not-supported eafnosupport))
(define-kinds name-service-error (netdb-internal-error) (netdb-success-error) (host-not-found-error) (no-address-error) (no-recovery-error) (try-again-error))

(defun ask (function &rest arguments)
  (apply #'uiop:symbol-call (py:import-module "cramhy_runtime.languages.commonlisp.sbcl.sockets") function arguments))

(defun checked (answer socket syscall &optional (kind 'socket-error))
  "The value in ANSWER, or the error that it tells."
  (destructuring-bind (done value &optional text) answer
    (if done
        value
        (error (or (car (find-if (lambda (entry) (and (rest entry) (ask '#:is_errno value (rest entry)))) *kinds*)) kind)
               :errno value :text text :socket socket :syscall syscall))))

;;; ---------------------------------------------------------------------------------------------------------------- sockets

(defclass socket ()
  ((handle :initform nil :accessor handle)
   (descriptor :initform -1 :accessor descriptor)
   (protocol :initarg :protocol :initform :tcp :reader socket-protocol)
   (type :initarg :type :initform nil :reader socket-type)
   (stream :initform nil :accessor stream-of)))
(defclass inet-socket (socket) ((family :initform "INET" :reader family)))
(defclass inet6-socket (socket) ((family :initform "INET6" :reader family)))
(defclass local-socket (socket) ((family :initform "UNIX" :reader family)))
(defclass local-abstract-socket (local-socket) ())

(defun number-of-protocol (socket)
  (if (or (string= (family socket) "UNIX") (null (socket-protocol socket))) 0 (values (get-protocol-by-name (socket-protocol socket)))))

(defmethod initialize-instance :after ((socket socket) &key handle)
  (unless (socket-type socket)
    (setf (slot-value socket 'type) (if (eq (socket-protocol socket) :udp) :datagram :stream)))
  (setf (slot-value socket 'protocol) (if (integerp (socket-protocol socket)) (socket-protocol socket) (number-of-protocol socket)))
  (setf (handle socket)
        (or handle
            (checked (ask '#:make (family socket) (if (eq (socket-type socket) :datagram) "DGRAM" "STREAM")) socket "socket"))
        (descriptor socket) (checked (ask '#:call (handle socket) "fileno") socket "socket")))

(defmethod print-object ((socket socket) stream)
  (print-unreadable-object (socket stream :type t :identity t)
    (format stream "~:[closed~;descriptor ~:*~A~]" (and (socket-open-p socket) (descriptor socket)))))

(defun make-inet-socket (type protocol) (make-instance 'inet-socket :type type :protocol protocol))
(defun socket-family (socket) (if (string= (family socket) "UNIX") 1 (if (string= (family socket) "INET6") 10 2)))
(defun socket-file-descriptor (socket) (descriptor socket))
(defun socket-open-p (socket) (/= (descriptor socket) -1))

(defparameter inaddr-any (coerce '(0 0 0 0) '(vector (unsigned-byte 8))))

(defun make-inet-address (dotted)
  "The vector of the address that is written as DOTTED."
  (let ((parts (mapcar #'parse-integer (uiop:split-string dotted :separator "."))))
    (coerce parts '(vector (unsigned-byte 8)))))

(defun make-inet6-address (text)
  "The vector of 16 octets of the address that is written as TEXT."
  (coerce (checked (ask '#:attempt (lambda () (uiop:symbol-call (py:import-module "socket") '#:inet_pton 10 text))) nil "inet_pton")
          '(vector (unsigned-byte 8))))

(defun written (address)
  "The text of an address: a vector of octets, or text already."
  (cond ((stringp address) address)
        ((= (length address) 4) (format nil "~{~D~^.~}" (coerce address 'list)))
        (t (format nil "~(~{~X~^:~}~)" (loop for i from 0 below 16 by 2 collect (+ (* 256 (elt address i)) (elt address (1+ i))))))))

(defun read-address (parts)
  "The values of an address that the system tells: the vector and the port, or the path."
  (if (consp parts)
      (values (if (find #\: (first parts)) (make-inet6-address (first parts)) (make-inet-address (first parts))) (second parts))
      parts))

(defun with-address (socket method syscall address)
  (checked (apply #'ask '#:call_with_address (handle socket) method (cons (written (first address)) (rest address))) socket syscall))

(defgeneric socket-bind (socket &rest address)
  (:method (socket &rest address) (with-address socket "bind" "bind" address) nil))
(defgeneric socket-connect (socket &rest address)
  (:method (socket &rest address) (with-address socket "connect" "connect" address) (descriptor socket)))
(defgeneric socket-listen (socket backlog)
  (:method (socket backlog) (checked (ask '#:call (handle socket) "listen" backlog) socket "listen") 0))

(defgeneric socket-accept (socket)
  (:method (socket)
    (destructuring-bind (handle address) (checked (ask '#:call (handle socket) "accept") socket "accept")
      (let ((made (allocate-instance (class-of socket))))
        (setf (slot-value made 'protocol) (socket-protocol socket) (slot-value made 'type) (socket-type socket)
              (slot-value made 'stream) nil (slot-value made 'family) (family socket)
              (slot-value made 'handle) handle (slot-value made 'descriptor) (checked (ask '#:call handle "fileno") made "accept"))
        (multiple-value-call #'values made (read-address address))))))

(defgeneric socket-name (socket)
  (:method (socket) (read-address (checked (ask '#:call (handle socket) "getsockname") socket "getsockname"))))
(defgeneric socket-peername (socket)
  (:method (socket) (read-address (checked (ask '#:call (handle socket) "getpeername") socket "getpeername"))))

(defgeneric socket-close (socket &key abort)
  (:method (socket &key abort)
    (when (socket-open-p socket)
      (if (stream-of socket) (close (stream-of socket) :abort abort) (ask '#:call (handle socket) "close"))
      (setf (descriptor socket) -1)
      t)))

(defgeneric socket-shutdown (socket &key direction)
  (:method (socket &key direction)
    (checked (ask '#:shutdown (handle socket) (member direction '(:input :io)) (member direction '(:output :io))) socket "shutdown")
    0))

(defgeneric socket-make-stream (socket &key input output element-type buffering external-format timeout auto-close serve-events)
  (:method (socket &key input output (element-type 'character) (buffering :full) (external-format :default) timeout auto-close serve-events)
    (declare (ignore buffering auto-close serve-events))
    (or (stream-of socket)
        (setf (stream-of socket)
              (ask '#:stream (handle socket) (or input (not output)) output (if (keywordp element-type) (string element-type) element-type)
                   (string (if (eq external-format :default) :utf-8 external-format)) timeout)))))

(defgeneric socket-send (socket buffer length &key address external-format oob eor dontroute dontwait nosignal confirm more)
  (:method (socket buffer length &key address (external-format :default) oob eor dontroute dontwait nosignal confirm more)
    (declare (ignore oob eor dontroute dontwait nosignal confirm more))
    (let ((octets (if (stringp buffer)
                      (sb-ext:string-to-octets (subseq buffer 0 (or length (length buffer)))
                                               :external-format (if (eq external-format :default) :utf-8 external-format))
                      (subseq buffer 0 (or length (length buffer))))))
      (checked (apply #'ask '#:send (handle socket) (coerce octets 'list)
                      (when address (cons (written (first address)) (rest address))))
               socket "sendto"))))

(defgeneric socket-receive (socket buffer length &key oob peek waitall dontwait element-type)
  (:method (socket buffer length &key oob peek waitall dontwait (element-type 'character))
    (declare (ignore oob))
    (let ((answer (ask '#:receive (handle socket) (or length (length buffer)) peek dontwait waitall)))
      (if (and dontwait (null (first answer)) (ask '#:is_errno (second answer) '(eagain ewouldblock)))
          (values nil nil nil nil)
          (destructuring-bind (octets address) (checked answer socket "recvfrom")
            (let ((text (equal (if buffer (array-element-type buffer) element-type) 'character))
                  (result (or buffer (make-array length :element-type element-type))))
              (replace result (if text (map 'list #'code-char octets) octets))
              (multiple-value-call #'values result (length octets) (read-address address))))))))

(defgeneric non-blocking-mode (socket)
  (:method (socket) (not (checked (ask '#:call (handle socket) "getblocking") socket "fcntl"))))
(defgeneric (setf non-blocking-mode) (on socket)
  (:method (on socket) (checked (ask '#:call (handle socket) "setblocking" (not on)) socket "fcntl") on))

(defmacro define-option (name level number kind)
  `(progn (defun ,name (socket)
            (let ((value (checked (ask '#:option (handle socket) ,level ,number) socket "getsockopt")))
              ,(if (eq kind 'boolean) '(/= value 0) 'value)))
          (defun (setf ,name) (value socket)
            (checked (ask '#:option (handle socket) ,level ,number ,(if (eq kind 'boolean) '(if value 1 0) 'value)) socket "setsockopt")
            value)))

(define-option sockopt-reuse-address "SOL_SOCKET" "SO_REUSEADDR" boolean)
(define-option sockopt-keep-alive "SOL_SOCKET" "SO_KEEPALIVE" boolean)
(define-option sockopt-broadcast "SOL_SOCKET" "SO_BROADCAST" boolean)
(define-option sockopt-oob-inline "SOL_SOCKET" "SO_OOBINLINE" boolean)
(define-option sockopt-tcp-nodelay "IPPROTO_TCP" "TCP_NODELAY" boolean)
(define-option sockopt-send-buffer "SOL_SOCKET" "SO_SNDBUF" integer)
(define-option sockopt-receive-buffer "SOL_SOCKET" "SO_RCVBUF" integer)
(define-option sockopt-priority "SOL_SOCKET" "SO_PRIORITY" integer)
(define-option sockopt-send-low-water "SOL_SOCKET" "SO_SNDLOWAT" integer)
(define-option sockopt-receive-low-water "SOL_SOCKET" "SO_RCVLOWAT" integer)
(define-option sockopt-type "SOL_SOCKET" "SO_TYPE" integer)
(define-option sockopt-debug "SOL_SOCKET" "SO_DEBUG" boolean)
(define-option sockopt-dont-route "SOL_SOCKET" "SO_DONTROUTE" boolean)
(define-option sockopt-bsd-compatible "SOL_SOCKET" "SO_BSDCOMPAT" boolean)
(define-option sockopt-pass-credentials "SOL_SOCKET" "SO_PASSCRED" boolean)
(define-option sockopt-bind-to-device "SOL_SOCKET" "SO_BINDTODEVICE" integer)
(define-option sockopt-tcp-keepidle "IPPROTO_TCP" "TCP_KEEPIDLE" integer)
(define-option sockopt-tcp-keepintvl "IPPROTO_TCP" "TCP_KEEPINTVL" integer)
(define-option sockopt-tcp-keepcnt "IPPROTO_TCP" "TCP_KEEPCNT" integer)

;;; ------------------------------------------------------------------------------------------------------------ names of hosts

(defclass host-ent ()
  ((name :initarg :name :reader host-ent-name)
   (aliases :initarg :aliases :initform nil :reader host-ent-aliases)
   (address-type :initarg :type :initform 2 :reader host-ent-address-type)
   (addresses :initarg :addresses :reader host-ent-addresses)))

(defgeneric host-ent-address (host)
  (:method (host) (first (host-ent-addresses host))))

(defun host-of (answer syscall)
  (destructuring-bind (name aliases addresses) (checked answer nil syscall 'host-not-found-error)
    (make-instance 'host-ent :name name :aliases aliases :addresses (mapcar (lambda (text) (values (read-address (list text)))) addresses))))

(defun get-host-by-name (name) (host-of (ask '#:host_by_name name) "get-host-by-name"))
(defun get-host-by-address (address) (host-of (ask '#:host_by_address (written address)) "get-host-by-address"))

(defun get-protocol-by-name (name)
  "Its number, its name, and another name."
  (let* ((name (string-downcase name)) (answer (ask '#:protocol_by_name name)))
    (if (first answer) (values (second answer) name (string-upcase name)) (error 'unknown-protocol :name name))))

(provide "SB-BSD-SOCKETS")
