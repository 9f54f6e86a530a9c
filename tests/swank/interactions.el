;;; What a user of SLIME does, by the commands that the keys are bound to.
;;; Each (interaction NAME FORM) writes a line: the name, a tab, and what FORM gave, as `prin1' prints it.
;;; The folder `here' has the files; the variables of this run stand in run.el there.

(require 'cl-lib)
(load (expand-file-name "run.el" (getenv "CRAMHY_TEST_FOLDER")))
(dolist (folder slime-folders) (add-to-list 'load-path folder))
(require 'slime)
(slime-setup '(slime-fancy slime-asdf))
(setq slime-lisp-implementations nil
      slime-kill-without-query-p t
      slime-compilation-finished-hook nil
      slime-display-compilation-output nil
      slime-load-failed-fasl 'never
      slime-repl-history-file (expand-file-name "history" here)
      inhibit-message t
      message-log-max t
      slime-log-events t
      create-lockfiles nil
      make-backup-files nil)

(defvar said nil "What Emacs has written into the echo area, the newest first.")
(advice-add 'message :before (lambda (text &rest values) (when text (push (apply #'format-message text values) said))))

(defun report (name value)
  (let ((print-escape-newlines t) (print-length nil) (print-level nil))
    (write-region (format "%s\t%S\n" name value) nil (expand-file-name "told" here) t 'quiet)))

(defmacro interaction (name &rest body)
  `(report ,name (condition-case problem (let ((found (progn ,@body))) (if (stringp found) (substring-no-properties found) found))
                   (error (let ((text (and (debugger) (with-current-buffer (debugger) (buffer-substring-no-properties (point-min) (point-max))))))
                            (ignore-errors (leave-debugger)) (list 'problem problem text))))))

(defun until (predicate &optional seconds)
  "Wait until PREDICATE holds; its value, or an error."
  (let ((end (+ (float-time) (or seconds patience))) found)
    (while (and (not (setq found (funcall predicate))) (< (float-time) end))
      (accept-process-output nil 0.01))
    (or found (error "It did not come about: %S" predicate))))

(defmacro eventually (&rest body) `(until (lambda () ,@body)))

(defun connect (folder &optional environment)
  "Do M-x slime in FOLDER."
  (let ((default-directory (file-name-as-directory folder))
        (process-environment (append environment process-environment))
        (before (length slime-net-processes)))
    (setq inferior-lisp-program lisp)
    (slime)
    (eventually (and (= (length slime-net-processes) (1+ before)) (not slime-connect-retry-timer)))
    (setq slime-default-connection (car slime-net-processes))
    (eventually (ignore-errors (slime-connection-output-buffer)))
    (eventually (prompt-there))))

(defun repl () (slime-connection-output-buffer))

(defun prompt-there ()
  (with-current-buffer (repl)
    (and (not (slime-rex-continuations)) (= (point-max) slime-repl-input-start-mark))))

(defun debugger ()
  (car (sldb-buffers (slime-connection))))

(defun type (text)
  "Type TEXT and RET into the REPL buffer; what came, or the text of the debugger."
  (with-current-buffer (repl)
    (goto-char (point-max))
    (let ((start (point)))
      (insert text)
      (let ((typed (point)))
        (slime-repl-return)
        (eventually (or (debugger) (prompt-there)))
        (if (debugger) (with-current-buffer (debugger) (buffer-string))
          (accept-process-output nil 0.02)
          (string-trim (buffer-substring-no-properties (min (1+ typed) (point-max))
                                                       (save-excursion (goto-char slime-repl-prompt-start-mark) (point)))))))))

(defmacro in-debugger (&rest body) `(with-current-buffer (debugger) ,@body))

(defun leave-debugger ()
  (in-debugger (sldb-quit))
  (eventually (and (not (debugger)) (prompt-there))))

(defun in-file (name)
  (let ((buffer (find-file-noselect (expand-file-name name here))))
    (switch-to-buffer buffer)
    (unless (eq major-mode 'lisp-mode) (lisp-mode))
    (slime-mode 1)
    buffer))

(defun line-here () (string-trim (buffer-substring-no-properties (line-beginning-position) (line-end-position))))

;;; ------------------------------------------------------------------------------------------------ the lectures

(defun lecture (name folder lines)
  (interaction (format "%s connects" name) (connect folder '("CRAMHY_TIME=virtual")) t)
  (let ((number 0))
    (dolist (line lines)
      (interaction (format "%s %d" name number)
        (prog1 (type line)
          (when (debugger) (leave-debugger))))
      (cl-incf number)))
  (interaction (format "%s prompt" name)
    (with-current-buffer (repl) (goto-char slime-repl-prompt-start-mark) (buffer-substring-no-properties (point) (point-max))))
  (slime-repl-quit-or-disconnect))

(defun slime-repl-quit-or-disconnect ()
  (let ((connections (length slime-net-processes)))
    (slime-quit-lisp-internal (slime-connection) 'slime-quit-sentinel t)
    (eventually (< (length slime-net-processes) connections))))

(lecture "lecture 34" folder-34 lines-34)
(lecture "lecture 38" folder-38 lines-38)

;;; -------------------------------------------------------------------------------------------- the other things

(interaction "connect" (connect folder-38) (slime-connected-p))
(interaction "evaluate" (type "(+ 1 2)"))
(interaction "evaluate several values" (type "(values 1 \"two\" :three)"))
(interaction "output" (type "(progn (format t \"hello~%\") 5)"))
(interaction "presentation is there"
  (with-current-buffer (repl)
    (goto-char (point-max)) (search-backward "5") (slime-presentation-p (get-text-property (point) 'slime-repl-presentation))))
(interaction "the last values" (type "(list * **)"))
(interaction "previous input"
  (with-current-buffer (repl)
    (goto-char (point-max)) (slime-repl-previous-input)
    (prog1 (buffer-substring-no-properties slime-repl-input-start-mark (point-max)) (slime-repl-kill-input))))
(interaction "read a line"
  (with-current-buffer (repl)
    (goto-char (point-max)) (insert "(read-line)") (slime-repl-return)
    (eventually slime-repl-read-mode)
    (goto-char (point-max)) (insert "typed") (slime-repl-return)
    (eventually (and (not slime-repl-read-mode) (prompt-there)))
    (goto-char (point-max)) (search-backward "\"typed\"") (line-here)))
(interaction "load the system" (type load-system))
(interaction "package prompt" (type "(in-package :tut)")
  (with-current-buffer (repl) (string-trim (buffer-substring-no-properties slime-repl-prompt-start-mark (point-max)))))
(interaction "set package" (with-current-buffer (repl) (slime-repl-set-package "CL-USER") (slime-lisp-package-prompt-string)))
(type "(in-package :tut)")
(interaction "start the node" (type "(start-ros-node \"turtle1\")"))
(interaction "start the turtle" (type "(init-ros-turtle \"turtle1\")"))

;;; compile a file with two errors, and jump to each

(in-file "two-errors.lisp")
(interaction "compile a file with two errors"
  (slime-compile-file) (eventually (not (slime-rex-continuations)))
  (sort (mapcar (lambda (note) (list (slime-note.severity note) (car (split-string (slime-note.message note) "\n")))) (slime-compiler-notes))
        (lambda (one other) (string< (cadr one) (cadr other)))))
(interaction "jump to the first error" (goto-char (point-min)) (slime-next-note) (list (line-number-at-pos) (line-here)))
(interaction "jump to the second error" (slime-next-note) (list (line-number-at-pos) (line-here)))
(interaction "jump back" (slime-previous-note) (line-number-at-pos))

;;; a good file

(in-file "good.lisp")
(interaction "compile and load a file"
  (slime-compile-and-load-file) (eventually (not (slime-rex-continuations))) (type "(double 21)"))
(interaction "compile a definition"
  (goto-char (point-min)) (search-forward "(* 2 x)") (replace-match "(* 3 x)") (slime-compile-defun)
  (eventually (not (slime-rex-continuations))) (type "(double 21)"))
(interaction "the end of a compilation" (cl-find-if (lambda (text) (string-prefix-p "Compilation" text)) said))
(interaction "a note of a definition"
  (goto-char (point-min)) (search-forward "(defun unused") (slime-compile-defun)
  (eventually (not (slime-rex-continuations)))
  (mapcar #'slime-note.severity (slime-compiler-notes)))
(interaction "the note is where the variable is"
  (goto-char (point-min)) (slime-next-note) (list (line-here) (thing-at-point 'symbol t)))
(interaction "evaluate the last expression"
  (goto-char (point-max)) (insert "\n(double 5)")
  (let (shown) (cl-letf (((symbol-function 'slime-display-eval-result) (lambda (value) (setq shown value))))
                 (slime-eval-last-expression) (eventually shown)) shown))
(interaction "evaluate a definition"
  (goto-char (point-min)) (search-forward "(defvar *factor*")
  (slime-eval-defun) (eventually (not (slime-rex-continuations))) (type "*factor*"))
(interaction "print the value into a buffer"
  (goto-char (point-max)) (slime-pprint-eval-last-expression) (eventually (not (slime-rex-continuations)))
  (with-current-buffer (slime-buffer-name :description) (string-trim (buffer-string))))
(interaction "evaluate and grab output"
  (slime-eval '(swank:eval-and-grab-output "(progn (princ :out) :value)")))
(interaction "load a file"
  (slime-load-file (expand-file-name "good.lisp" here)) (eventually (not (slime-rex-continuations))) (type "(double 1)"))

;;; while one types

(defun complete (text command)
  (with-current-buffer (repl)
    (goto-char (point-max)) (insert text) (funcall command)
    (eventually (not (slime-rex-continuations)))
    (prog1 (buffer-substring-no-properties slime-repl-input-start-mark (point-max))
      (ignore-errors (slime-fuzzy-abort))
      (goto-char (point-max)) (slime-repl-kill-input))))
(interaction "complete" (complete "(with-failure-h" #'slime-complete-symbol))
(interaction "complete a keyword" (with-current-buffer (repl) (car (slime-eval '(swank:completions-for-keyword ":na" '("make-fluent" swank::%cursor-marker%))))))
(interaction "complete fuzzily" (caar (slime-fuzzy-completions "mvbind")))
(interaction "complete parts of words" (complete "(m-v-b" #'slime-complete-symbol*))
(defun arglist-at (text)
  (with-current-buffer (repl)
    (goto-char (point-max)) (insert text)
    (let ((found (slime-eval `(swank:autodoc ',(slime-parse-form-upto-point slime-autodoc-accuracy-depth)))))
      (slime-repl-kill-input)
      (car found))))
(interaction "autodoc" (arglist-at "(mapcar #'car "))
(interaction "autodoc of one's own function" (arglist-at "(send-vel-cmd 1 "))
(interaction "autodoc of a plan's operator" (arglist-at "(top-level (par "))
(interaction "autodoc of keywords" (arglist-at "(make-fluent :name "))
(interaction "autodoc of a variable" (arglist-at "(list *factor*"))
(interaction "autodoc of a binding" (arglist-at "(let ((double "))
(interaction "arglist in the echo area" (slime-eval '(swank:operator-arglist "send-vel-cmd" "TUT")))

;;; finding

(defun definition (name)
  (with-current-buffer (repl) (slime-edit-definition name)
    (eventually (not (slime-rex-continuations)))
    (list (file-name-nondirectory (or (buffer-file-name (window-buffer)) (buffer-name (window-buffer))))
          (with-current-buffer (window-buffer) (goto-char (window-point)) (line-here)))))
(interaction "M-. into Lisp" (definition "send-vel-cmd"))
(interaction "M-. to a variable" (definition "*turtle-pose*"))
(interaction "M-. to a process module" (definition "turtlesim-navigation"))
(interaction "M-. into Hy" (slime-eval `(swank:load-file ,(expand-file-name "greeting.hy" here))) (definition "greet-from-hy"))
(interaction "M-. into Python" (car (definition "roslisp:publish")))
(interaction "M-. back" (slime-pop-find-definition-stack) t)
(interaction "M-. to nothing" (condition-case problem (progn (definition "no-such-thing-at-all") nil) (error (error-message-string problem))))
(interaction "who calls"
  (mapcar #'car (slime-eval '(swank:xref ':calls "send-vel-cmd") "TUT")))
(interaction "who binds" (slime-eval '(swank:xref ':binds "*turtle-pose*") "TUT"))

;;; telling

(defun described ()
  (eventually (not (slime-rex-continuations)))
  (with-current-buffer (slime-buffer-name :description) (string-trim (buffer-string))))
(interaction "describe a symbol" (with-current-buffer (repl) (slime-describe-symbol "send-vel-cmd") (described)))
(interaction "describe a function" (with-current-buffer (repl) (slime-describe-function "mapcar") (described)))
(interaction "documentation" (with-current-buffer (repl) (slime-documentation "par") (described)))
(interaction "apropos"
  (with-current-buffer (repl) (slime-apropos "vel-cmd" nil "TUT") (eventually (not (slime-rex-continuations))))
  (with-current-buffer (slime-buffer-name :apropos) (string-trim (buffer-string))))
(in-file "good.lisp")
(interaction "expand a macro once"
  (goto-char (point-max)) (insert "\n(when a (unless b c))") (backward-sexp)
  (slime-macroexpand-1) (eventually (get-buffer (slime-buffer-name :macroexpansion)))
  (eventually (not (slime-rex-continuations)))
  (with-current-buffer (slime-buffer-name :macroexpansion) (string-trim (buffer-string))))
(interaction "expand all macros" (slime-eval '(swank:swank-macroexpand-all "(when a (unless b c))")))
(interaction "disassemble" (car (split-string (slime-eval '(swank:disassemble-form "'double")) "\n")))
(interaction "trace" (slime-eval '(swank:swank-toggle-trace "double")))
(interaction "a traced call" (type "(double 2)"))
(interaction "trace no more" (slime-eval '(swank:swank-toggle-trace "double")))
(interaction "record calls"
  (slime-eval '(swank-trace-dialog:dialog-toggle-trace (swank::from-string "double")) "TUT")
  (type "(double 4)")
  (slime-trace-dialog t)
  (eventually (not (slime-rex-continuations)))
  (with-current-buffer (slime-trace-dialog--live-dialog)
    (string-trim (buffer-substring-no-properties (progn (goto-char (point-max)) (search-backward "DOUBLE") (line-beginning-position)) (point-max)))))
(interaction "inspect a recorded call"
  (slime-eval-async '(swank::inspect-object (swank-trace-dialog::find-trace 0)) #'slime-open-inspector)
  (eventually (not (slime-rex-continuations)))
  (with-current-buffer (slime-inspector-buffer) (prog1 (string-trim (buffer-string)) (slime-inspector-quit))))
(interaction "untrace all" (slime-eval '(cl:progn (swank-trace-dialog:dialog-untrace-all) (swank-trace-dialog:report-specs))))
(interaction "the files of a system"
  (mapcar #'file-name-nondirectory (slime-eval '(swank:asdf-system-files "cram-my-beginner-tutorial"))))
(interaction "undefine" (slime-eval '(swank:undefine-function "unused")))
(interaction "change the folder" (slime-set-default-directory here) (string= (slime-eval '(swank:default-directory)) (file-name-as-directory (expand-file-name here))))

;;; the inspector

(defun inspector-text ()
  (eventually (<= (length (slime-rex-continuations)) (if (debugger) 1 0))) ; the form in the debugger has not ended
  (with-current-buffer (slime-inspector-buffer) (string-trim (buffer-string))))
(defun go-into (text)
  (with-current-buffer (slime-inspector-buffer)
    (goto-char (point-min)) (search-forward text) (goto-char (match-beginning 0))
    (slime-inspector-operate-on-point))
  (inspector-text))
(interaction "inspect a designator"
  (with-current-buffer (repl) (slime-inspect "(desig:a motion (type driving) (speed 5) (angle 2))")) (inspector-text))
(interaction "copy a part into the REPL"
  (with-current-buffer (slime-inspector-buffer) (slime-inspector-copy-down-to-repl 2))
  (eventually (not (slime-rex-continuations))) (type "cl:*"))
(interaction "inspect a part" (go-into ":DRIVING"))
(interaction "inspector goes back" (with-current-buffer (slime-inspector-buffer) (slime-inspector-pop)) (inspector-text))
(interaction "resolve the designator" (go-into "[resolve it]"))
(interaction "inspector goes forth"
  (with-current-buffer (slime-inspector-buffer) (slime-inspector-pop)) (inspector-text)
  (with-current-buffer (slime-inspector-buffer) (slime-inspector-next)) (inspector-text))
(interaction "inspect a fluent" (with-current-buffer (repl) (slime-inspect "*turtle-pose*")) (inspector-text))
(interaction "inspector is left" (with-current-buffer (slime-inspector-buffer) (slime-inspector-quit)) t)

;;; the debugger

(interaction "an error inside par opens the debugger"
  (type "(top-level (par (sleep 0.01) (let ((speed 5)) (broken-plan speed 2))))"))
(interaction "the frames" (in-debugger (buffer-substring-no-properties sldb-backtrace-start-marker (point-max))))
(interaction "the locals"
  (in-debugger (mapcar (lambda (variable) (cons (plist-get variable :name) (plist-get variable :value))) (car (slime-eval '(swank:frame-locals-and-catch-tags 0))))))
(interaction "the source of a frame"
  (in-debugger (slime-eval '(swank:frame-source-location 0)) (goto-char sldb-backtrace-start-marker) (sldb-show-source))
  (eventually (with-current-buffer "good.lisp" (string-match "undefined-here" (line-here))))
  (with-current-buffer "good.lisp" (line-here)))
(interaction "evaluate in a frame" (in-debugger (slime-eval '(swank:eval-string-in-frame "(list speed angle)" 0 "TUT"))))
(interaction "print in a frame" (in-debugger (slime-eval '(swank:pprint-eval-string-in-frame "(+ speed angle)" 0 "TUT"))))
(interaction "disassemble a frame" (in-debugger (stringp (slime-eval '(swank:sldb-disassemble 0)))))
(interaction "return from a frame"
  (setq said nil)
  (in-debugger (goto-char sldb-backtrace-start-marker) (sldb-return-from-frame "1"))
  (eventually said)
  (car said))
(interaction "inspect the condition" (in-debugger (sldb-inspect-condition)) (inspector-text))
(interaction "inspect a local" (in-debugger (goto-char sldb-backtrace-start-marker) (slime-eval '(swank:inspect-frame-var 0 0)) t))
(interaction "an error in the debugger"
  (in-debugger (slime-eval-async '(swank:eval-string-in-frame "(car 5)" 0 "TUT")))
  (eventually (and (debugger) (eql 2 (buffer-local-value 'sldb-level (debugger)))))
  (in-debugger (mapcar (lambda (restart) (substring-no-properties (cadr restart))) sldb-restarts)))
(interaction "back to the first level"
  (in-debugger (slime-eval-async '(swank:invoke-nth-restart-for-emacs 2 0)))
  (eventually (and (debugger) (eql 1 (buffer-local-value 'sldb-level (debugger)))))
  t)
(interaction "leave the debugger" (leave-debugger) (prompt-there))
(interaction "an aborted form names its condition"
  (with-current-buffer (repl) (goto-char (point-max)) (search-backward "; Evaluation aborted on") (line-here)))
(defun compile-for-debugging (text)
  (in-file "good.lisp")
  (goto-char (point-max)) (insert "\n\n" text "\n") (forward-line -1)
  (slime-compile-defun '(4)) (eventually (not (slime-rex-continuations))))
(interaction "let a call return a value"
  (compile-for-debugging "(defun careful (x) (+ 1 (car x)))")
  (type "(list (careful 5) 2)")
  (in-debugger (goto-char sldb-backtrace-start-marker) (sldb-return-from-frame "(* 10 x)"))
  (eventually (and (not (debugger)) (prompt-there)))
  (with-current-buffer (repl) (goto-char (point-max)) (forward-line -1) (line-here)))
(interaction "begin a call anew"
  (compile-for-debugging "(defun careful-2 (x) (if (= *factor* 13) x (car x)))")
  (type "(setf *factor* 12)") (type "(careful-2 5)")
  (slime-eval '(swank:interactive-eval "(setf *factor* 13)") "TUT")
  (in-debugger (goto-char sldb-backtrace-start-marker) (sldb-restart-frame))
  (eventually (and (not (debugger)) (prompt-there)))
  (with-current-buffer (repl) (goto-char (point-max)) (forward-line -1) (line-here)))
(interaction "take a restart"
  (type "(broken-plan 1 2)")
  (in-debugger (sldb-invoke-restart (cl-position "USE-VALUE" sldb-restarts :key #'car :test #'string=)))
  (eventually (buffer-local-value 'slime-repl-read-mode (repl)))
  (with-current-buffer (repl) (goto-char (point-max)) (insert "10") (slime-repl-return)
    (eventually (and (not (debugger)) (not slime-repl-read-mode) (prompt-there)))
    (goto-char (point-max)) (forward-line -1) (line-here)))
(interaction "continue" (type "(progn (break) 7)")
  (in-debugger (sldb-continue)) (eventually (and (not (debugger)) (prompt-there)))
  (with-current-buffer (repl) (goto-char (point-max)) (search-backward "7") (line-here)))

;;; plans that run

(defun begin (text)
  (with-current-buffer (repl) (goto-char (point-max)) (insert text) (slime-repl-return)))
(defun pose () (slime-eval '(swank:interactive-eval "(let ((pose (value *turtle-pose*))) (list (turtlesim-msg:x pose) (turtlesim-msg:y pose)))") "TUT"))
(interaction "the turtle moves" (let ((before (pose))) (begin "(top-level (move-to-far))")
  (eventually (not (equal before (pose))))))
(interaction "interrupt, and the turtle stops"
  (with-current-buffer (repl) (slime-interrupt)) (eventually (prompt-there))
  (sleep-for 0.3) (let ((one (pose))) (sleep-for 0.5) (equal one (pose))))
(interaction "the session goes on" (type "(+ 1 1)"))
(interaction "list the tasks"
  (begin "(top-level (par (loop (sleep 0.1)) (loop (sleep 0.2))))")
  (sleep-for 0.5)
  (let ((threads (slime-eval '(swank:list-threads))))
    (list (car threads) (mapcar #'cadr (cdr threads)))))
(interaction "kill one"
  (let* ((threads (cdr (slime-eval '(swank:list-threads))))
         (index (cl-position-if (lambda (thread) (string-match "listener-eval" (cadr thread))) threads)))
    (slime-eval `(cl:mapc 'swank:kill-nth-thread '(,index)))
    (eventually (prompt-there)) t))

;;; several connections, the end, and back again

(interaction "connect again"
  (let ((port (cadr (process-contact (slime-connection)))) (before (slime-connection)))
    (slime-connect "127.0.0.1" port)
    (eventually (and (not (eq before slime-default-connection)) (slime-connected-p)))
    (eventually (ignore-errors (slime-connection-output-buffer)))
    (eventually (prompt-there))
    (list (length slime-net-processes) (type "(package-name *package*)"))))
(interaction "disconnect"
  (slime-disconnect) (eventually (= 1 (length slime-net-processes)))
  (setq slime-default-connection (car slime-net-processes)) (type "(+ 2 2)"))
(interaction "reconnect"
  (let ((port (cadr (process-contact (slime-connection)))))
    (slime-disconnect) (eventually (null slime-net-processes))
    (slime-connect "127.0.0.1" port)
    (eventually (slime-connected-p)) (eventually (ignore-errors (slime-connection-output-buffer))) (eventually (prompt-there))
    (type "(tut::double 2)")))
(interaction "quit" (slime-repl-quit-or-disconnect) (null slime-net-processes))
(kill-emacs 0)
