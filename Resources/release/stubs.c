/* Stubs of two libraries that the archive does not contain, for the symbols that its libraries use.
 * release.sh compiles this file once for each.
 *
 * STUB_CURL: HDF5 uses libcurl to read files from the web, which Fenestra never does. libcurl would
 * add 26 libraries. STUB_JBIG: libtiff uses libjbig, which is under the GPL, to read bilevel JBIG
 * images. They are rejected here. */

#ifdef STUB_CURL
/* Succeeds, since HDF5 initializes libcurl even if it does not need it. */
int curl_global_init(long flags) {
  (void)flags;
  return 0;
}
void curl_global_cleanup(void) {}
/* Returns null: no connection. */
void* curl_easy_init(void) {
  return 0;
}
void curl_easy_cleanup(void* connection) {
  (void)connection;
}
enum { failed_init = 2 };
int curl_easy_perform(void* connection) {
  (void)connection;
  return failed_init;
}
int curl_easy_setopt(void* connection, int option, ...) {
  (void)connection;
  (void)option;
  return failed_init;
}
void* curl_slist_append(void* list, const char* text) {
  (void)list;
  (void)text;
  return 0;
}
void curl_slist_free_all(void* list) {
  (void)list;
}
#endif

#ifdef STUB_JBIG
enum { unsupported = 1 };
void jbg_dec_init(void* state) {
  (void)state;
}
int jbg_dec_in(void* state, unsigned char* data, unsigned long size, unsigned long* read) {
  (void)state;
  (void)data;
  (void)size;
  (void)read;
  return unsupported;
}
const char* jbg_strerror(int status) {
  (void)status;
  return "JBIG images are not supported by this build";
}
unsigned long jbg_dec_getsize(const void* state) {
  (void)state;
  return 0;
}
unsigned char* jbg_dec_getimage(const void* state, int plane) {
  (void)state;
  (void)plane;
  return 0;
}
void jbg_dec_free(void* state) {
  (void)state;
}
int jbg_newlen(unsigned char* data, unsigned long size) {
  (void)data;
  (void)size;
  return unsupported;
}
void jbg_enc_init(void* state) {
  (void)state;
}
void jbg_enc_out(void* state) {
  (void)state;
}
void jbg_enc_free(void* state) {
  (void)state;
}
#endif
