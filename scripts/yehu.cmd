@echo off
rem Runs yehu-server from this checkout on Windows, as scripts/yehu does elsewhere.
rem The first use sets up .venv; PYTHON names another Python than the newest here.
rem
rem   scripts\yehu ARGS...
setlocal
for %%f in ("%~dp0..") do set "root=%%~ff"
set "venv=%root%\.venv"
set "same=import filecmp, sys; sys.exit(not filecmp.cmp(*sys.argv[1:], shallow=False))"
"%venv%\Scripts\python.exe" -I -c "%same%" "%root%\requirements\run.lock" "%venv%\stamp-run" >nul 2>nul
if not errorlevel 1 goto run

echo yehu: setting up .venv ^(about half a minute^), once ... 1>&2
if not defined PYTHON set "PYTHON=python"
"%PYTHON%" -I -m venv --clear "%venv%"
if errorlevel 1 goto no_python
set "pip="%venv%\Scripts\python.exe" -I -m pip --disable-pip-version-check --quiet install"
%pip% --require-hashes --no-build-isolation -r "%root%\requirements\run.lock"
if errorlevel 1 exit /b 1
%pip% --no-deps --no-build-isolation --editable "%root%"
if errorlevel 1 exit /b 1
copy /b "%root%\requirements\run.lock" "%venv%\stamp-run" >nul

:run
rem Without bytecode each start compiles 400 files, for a second.
set PYTHONDONTWRITEBYTECODE=
rem For hints.
set "YEHU_COMMAND=%~0"
"%venv%\Scripts\yehu-server.exe" %*
exit /b %errorlevel%

:no_python
echo yehu: needs Python 3.11 to 3.14; set PYTHON to its python.exe 1>&2
exit /b 1
