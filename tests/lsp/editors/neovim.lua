-- Drives Neovim's own client against cramhy lsp: nvim --headless -u NONE -l ..., with CRAMHY_PROGRAM and CRAMHY_FILE. Prints lines.
local uri
local told
vim.lsp.handlers["textDocument/publishDiagnostics"] = function(_, result)
  if result.uri == uri then
    told = result.diagnostics
  end
end
vim.cmd("edit " .. vim.fn.fnameescape(vim.env.CRAMHY_FILE))
vim.bo.filetype = "lisp"
uri = vim.uri_from_bufnr(0)
local id = vim.lsp.start_client({ name = "cramhy", cmd = { vim.env.CRAMHY_PROGRAM, "lsp" }, root_dir = vim.fn.getcwd() })
vim.lsp.buf_attach_client(0, id)
vim.wait(120000, function() return told ~= nil end, 50)
for _, each in ipairs(told or {}) do
  io.write(("diagnostic %d %s\n"):format(each.range.start.line + 1, vim.split(each.message, "\n")[1]))
end
vim.fn.search([[(send-vel-cmd 1.5]])
vim.cmd("normal! 3l")
local function ask(method)
  local found = vim.lsp.buf_request_sync(0, method, vim.lsp.util.make_position_params(), 120000)
  return found and found[id] and found[id].result
end
for _, each in ipairs(ask("textDocument/definition") or {}) do
  io.write(("definition %s\n"):format(vim.fn.fnamemodify(vim.uri_to_fname(each.uri), ":t")))
end
local hover = ask("textDocument/hover")
if hover then
  io.write(("hover %s\n"):format(vim.split(hover.contents.value, "\n")[1]))
end
vim.lsp.stop_client(id)
vim.cmd("qall!")
