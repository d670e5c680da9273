/* What libraries of the archive ask of two that it leaves out. Compiled once for each, by
 * release.sh.
 *
 * ABSENT_CURL: HDF5 reads files from the web with libcurl, which Fenestra never asks it to; libcurl
 * would bring 26 more libraries. ABSENT_JBIG: libtiff reads JBIG's bilevel pictures with libjbig,
 * which is under the GPL: such a picture is refused here. */

#ifdef ABSENT_CURL
/* Success: HDF5 prepares libcurl before it knows whether it needs it. */
int curl_global_init(long flags) {
  (void)flags;
  return 0;
}
void curl_global_cleanup(void) {}
/* Null: no connection. */
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

#ifdef ABSENT_JBIG
enum { refused = 1 };
void jbg_dec_init(void* state) {
  (void)state;
}
int jbg_dec_in(void* state, unsigned char* data, unsigned long size, unsigned long* read) {
  (void)state;
  (void)data;
  (void)size;
  (void)read;
  return refused;
}
const char* jbg_strerror(int status) {
  (void)status;
  return "pictures in JBIG are not read by this build";
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
  return refused;
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
