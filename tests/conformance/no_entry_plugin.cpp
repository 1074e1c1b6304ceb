// A library under a plugin's name that is none.
extern "C" int something_else() { return 0; }
